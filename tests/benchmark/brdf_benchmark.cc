#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <benchmark/benchmark.h>

#include "brdf/callisto.h"
#include "brdf/disney2012.h"
#include "brdf/ggx.h"
#include "brdf/lambert.h"

// One evaluation of a model for given directions, without derivatives: 'items' are evaluations.
namespace likeness::brdf {
namespace {

constexpr std::size_t kPairs = 1024;  // cycled: enough that no branch is learnt, small enough for the L1 cache

// Pairs of directions spread over the hemisphere by the golden angle, the same at every run.
template <class S>
std::array<std::array<Vec3<S>, 2>, kPairs> directions() {
  const auto spread = [](double i, double n) {
    const double z = (i + 0.5) / n, r = std::sqrt(1 - z * z), phi = i * std::numbers::pi * (3 - std::sqrt(5.0));
    return Vec3<S>(S(r * std::cos(phi)), S(r * std::sin(phi)), S(z));
  };
  std::array<std::array<Vec3<S>, 2>, kPairs> pairs;
  for (std::size_t i = 0; i < kPairs; ++i)
    pairs[i] = {spread(double(i), double(kPairs)), spread(double(i * 37 % kPairs), double(kPairs))};
  return pairs;
}

template <template <class> class Model, class S>
void Eval(benchmark::State& state) {
  const auto pairs = directions<S>();
  const Model<S> model;
  S sum(0);
  for (auto _ : state) {
    for (const auto& [to_light, to_view] : pairs) sum += model.eval(to_light, to_view).g;
  }
  if (!std::isfinite(double(sum))) state.SkipWithError("a value was not finite");
  state.SetItemsProcessed(state.iterations() * std::int64_t(kPairs));
}

BENCHMARK(Eval<Lambert, double>);
BENCHMARK(Eval<Ggx, double>);
BENCHMARK(Eval<Disney2012, double>);
BENCHMARK(Eval<Callisto, double>);
BENCHMARK(Eval<Callisto, float>);

}  // namespace
}  // namespace likeness::brdf
