#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "brdf/jet.h"
#include "tests/brdf/evaluator_row.h"

// The derivative of an evaluator's outputs by one of its inputs: automatic, and as a difference in long double.
namespace likeness::brdf {

template <class E, class Form, class S>
std::vector<S> outputs_of(const std::vector<S>& in) {
  std::vector<S> out(output_count<E>());
  const void* tables = nullptr;
  if constexpr (HasTables<E>) tables = &E::tables();
  evaluate_inputs<E, Form>(tables, in.data(), out.data());
  return out;
}

// Expects d(outputs)/d(in[k]) of E, prepare() included, to be finite and equal to a central difference of `step`
// (relative to the input, or absolute where that is below 1), to `tolerance` of the derivative or of the output over the
// input, whichever is larger. side: 1 or -1 for a difference to one side, at the end of a range.
template <class E, class Form = std::tuple_element_t<0, typename E::Forms>>
void expect_slope(const std::vector<double>& in, std::size_t k, double tolerance, double step = 1e-5, int side = 0) {
  using Dual = ceres::Jet<double, 1>;
  std::vector<Dual> dual(in.begin(), in.end());
  dual[k].v[0] = 1;
  const auto automatic = outputs_of<E, Form>(dual);

  const auto moved = [&](long double by) {
    std::vector<long double> at(in.begin(), in.end());
    at[k] += by;
    return outputs_of<E, Form>(at);
  };
  const long double scale = std::max(1.0, std::abs(in[k])), h = step * scale;
  const auto here = moved(0), ahead = moved(h), back = moved(-h), far_ahead = moved(2 * h), far_back = moved(-2 * h);
  for (std::size_t o = 0; o < automatic.size(); ++o) {
    const long double wide = side == 0  ? (8 * (ahead[o] - back[o]) - (far_ahead[o] - far_back[o])) / (12 * h)
                             : side > 0 ? (4 * ahead[o] - 3 * here[o] - far_ahead[o]) / (2 * h)
                                        : (3 * here[o] - 4 * back[o] + far_back[o]) / (2 * h);
    const double want = double(wide), got = automatic[o].v[0];
    std::string where = std::string(E::kName) + ": output " + std::to_string(o) + " by input " + std::to_string(k);
    for (const double x : in) where += " " + std::to_string(x);
    ASSERT_TRUE(std::isfinite(automatic[o].a) && std::isfinite(got)) << where;
    EXPECT_NEAR(got, want, tolerance * std::max(std::abs(want), std::abs(double(here[o]) / double(scale))) + 1e-15)
        << where;
  }
}

}  // namespace likeness::brdf
