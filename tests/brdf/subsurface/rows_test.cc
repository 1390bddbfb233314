#include <cmath>

#include "brdf/subsurface/evaluators.h"
#include "tests/brdf/evaluator_row.h"

// Every row of the family at once: edges, float against double, lanes against single numbers.
namespace likeness::brdf {
namespace {

template <class E>
class EveryRow : public ::testing::Test {};
template <class... E>
::testing::Types<E...> types_of(const std::tuple<E...>*);
struct RowNames {
  template <class E>
  static std::string GetName(int) {
    return std::string(E::kName);
  }
};
// The walk takes seconds where others take nanoseconds: random_walk_test has it.
template <class... Kept, class... E>
auto without_walks(std::tuple<Kept...>*, const std::tuple<E...>*) {
  return std::tuple_cat(std::conditional_t<OneByOne<E>, std::tuple<>, std::tuple<E>>()...);
}
using Batched =
    decltype(without_walks(static_cast<std::tuple<>*>(nullptr), static_cast<SubsurfaceEvaluators*>(nullptr)));
TYPED_TEST_SUITE(EveryRow, decltype(types_of(static_cast<Batched*>(nullptr))), RowNames);

template <class E>
using FormOf = std::tuple_element_t<0, typename E::Forms>;

// Inputs over the whole range; half of them at an end, at 0 or at the default.
template <class E>
std::vector<double> edge_inputs(Random& random) {
  std::vector<double> in;
  for (const Parameter& row : FormOf<E>::kInputs)
    for (int channel = 0; channel < row.channels; ++channel) {
      const double ends[]{row.range.low, row.range.high, row.initial, row.range.low > 0 ? row.initial : 0};
      const double least = std::max(row.range.low, 1e-12),
                   from = random.uniform(std::log(least), std::log(row.range.high));
      in.push_back(random.uniform() < 0.4   ? ends[random.index(4)]
                   : random.uniform() < 0.5 ? std::exp(from)
                                            : random.uniform(row.range.low, row.range.high));
    }
  return in;
}
template <class E>
std::vector<double> usual_inputs(Random& random) {
  std::vector<double> in;
  for (const Parameter& row : FormOf<E>::kInputs)
    for (int channel = 0; channel < row.channels; ++channel)
      in.push_back(row.logarithmic && row.typical.low > 0
                       ? std::exp(random.uniform(std::log(row.typical.low), std::log(row.typical.high)))
                       : random.uniform(row.typical.low, row.typical.high));
  return in;
}

template <class E, class S>
::testing::AssertionResult sound(const std::vector<double>& in) {
  const auto out = evaluate_row<E, S>(in);
  std::size_t at = 0;
  for (const Output& output : E::kOutputs)
    for (int channel = 0; channel < output.channels; ++channel, ++at)
      if (!std::isfinite(out[at]) || (out[at] < 0 && !output.may_be_negative)) {
        auto failure = ::testing::AssertionFailure() << output.name << " = " << out[at] << " at";
        for (const double x : in) failure << " " << x;
        return failure;
      }
  return ::testing::AssertionSuccess();
}

TYPED_TEST(EveryRow, IsFiniteAndNotNegativeAtEveryEdgeOfItsRange) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto in = edge_inputs<TypeParam>(random);
    ASSERT_TRUE((sound<TypeParam, double>(in)));
    ASSERT_TRUE((sound<TypeParam, float>(in)));
    ASSERT_TRUE((sound<TypeParam, xsimd::batch<float>>(in)));
    if (i % 8 == 0) {
      ASSERT_TRUE((sound<TypeParam, xsimd::batch<double>>(in)));
    }
  }
}

TYPED_TEST(EveryRow, InFloatIsNearDouble) {
  Random random(2);
  for (int i = 0; i < 20000; ++i) {
    const auto in = usual_inputs<TypeParam>(random);
    const auto want = evaluate_row<TypeParam, double>(in);
    for (const auto& got : {evaluate_row<TypeParam, float>(in), evaluate_row<TypeParam, xsimd::batch<float>>(in)})
      for (std::size_t k = 0; k < want.size(); ++k)
        // The demand; below 1e-33 a float's exponential is 0, and its product with what follows.
        ASSERT_LE(relative_difference(got[k], want[k], 1e-33), 2e-5)
            << TypeParam::kOutputs[std::min(k, TypeParam::kOutputs.size() - 1)].name << " " << i;
  }
}

// Each lane has inputs of its own, as the masks of a row must tell them apart.
TYPED_TEST(EveryRow, ALaneIsWhatASingleNumberIs) {
  using B = xsimd::batch<float>;
  constexpr std::size_t kFeatures = feature_count<TypeParam>(), kOut = output_count<TypeParam>();
  Random random(3);
  for (int i = 0; i < 5000; ++i) {
    float lanes[kFeatures][B::size];
    std::vector<std::vector<double>> single;
    for (std::size_t lane = 0; lane < B::size; ++lane) {
      const auto in = usual_inputs<TypeParam>(random);
      double features[kFeatures];
      FormOf<TypeParam>::prepare(in.data(), features);
      for (std::size_t k = 0; k < kFeatures; ++k) lanes[k][lane] = float(features[k]);
      single.push_back(evaluate_row<TypeParam, float>(in));
    }
    B features[kFeatures], out[kOut];
    for (std::size_t k = 0; k < kFeatures; ++k) features[k] = B::load_unaligned(lanes[k]);
    TypeParam::evaluate(features, out);
    for (std::size_t lane = 0; lane < B::size; ++lane)
      for (std::size_t k = 0; k < kOut; ++k)
        ASSERT_LE(relative_difference(out[k].get(lane), single[lane][k], 1e-33), 2e-5)
            << "output " << k;  // of exponents up to 80, at radii that differ in the last bits
  }
}

// The range of a row's inputs, as engines name them: by these columns the reference files and `likeness eval` find them.
TEST(Rows, HaveTheirNames) {
  EXPECT_EQ(BurleyIcdfHalleySteps<3>::kName, "burley_icdf_halley_3");
  EXPECT_EQ(GaussianProfileOf<4>::kName, "gaussian_profile_4");
}

}  // namespace
}  // namespace likeness::brdf
