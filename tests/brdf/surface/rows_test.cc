#include "brdf/surface_evaluators.h"
#include "tests/brdf/evaluator_row.h"

// The rows of `likeness eval` against the files of 40 digits, through the forms that name their columns.
namespace likeness::brdf {
namespace {

template <class S>
class SurfaceRows : public ::testing::Test {};
TYPED_TEST_SUITE(SurfaceRows, Kinds, KindNames);

template <std::size_t I, class E>
using FormAt = std::tuple_element_t<I, typename E::Forms>;

TYPED_TEST(SurfaceRows, BurleyDiffuseTakesCosines) {
  if (read_reference("burley_diffuse.csv").empty())
    GTEST_SKIP() << "no " LIKENESS_SHARED_DIR "/reference/burley_diffuse.csv";
  worst_against_file<BurleyDiffuseRow, TypeParam, FormAt<3, BurleyDiffuseRow>>("burley_diffuse.csv", {});
}
TYPED_TEST(SurfaceRows, CallistoTakesHalfAngles) {
  if (read_reference("callisto.csv").empty()) GTEST_SKIP() << "no " LIKENESS_SHARED_DIR "/reference/callisto.csv";
  worst_against_file<Surface<Callisto>, TypeParam, FormAt<1, Surface<Callisto>>>("callisto.csv",
                                                                                 {.zero_double = 1e-15});
}
TYPED_TEST(SurfaceRows, GgxDTakesACosine) {
  if (read_reference("ggx_d.csv").empty()) GTEST_SKIP() << "no " LIKENESS_SHARED_DIR "/reference/ggx_d.csv";
  worst_against_file<GgxD, TypeParam>("ggx_d.csv", {});
}

TYPED_TEST(SurfaceRows, ACosineOfZeroIsDark) {
  using S = TypeParam;
  for (const double f : evaluate_row<BurleyDiffuseRow, S, FormAt<3, BurleyDiffuseRow>>({0, 0.5, 0.5, 1, 1, 1, 0.5}))
    EXPECT_EQ(f, 0);
  for (const double f : evaluate_row<BurleyDiffuseRow, S, FormAt<3, BurleyDiffuseRow>>({0.5, 0, 0.5, 1, 1, 1, 0.5}))
    EXPECT_EQ(f, 0);
  for (const double f : evaluate_row<ProximaRow, S, FormAt<3, ProximaRow>>({0, 0.5, 1, 1, 1, 0.5})) EXPECT_EQ(f, 0);
}

TYPED_TEST(SurfaceRows, CallistoProximaReturnsBothWithAndWithoutTheCosine) {
  using S = TypeParam;
  using Row = SurfaceWithCosine<CallistoProxima>;
  std::vector<double> in{0.6, 0, 0.8, 0, 0, 1};
  for (const double x : channels_of(CallistoProxima<double>{})) in.push_back(x);
  const auto out = evaluate_row<Row, S>(in);
  ASSERT_EQ(out.size(), 6u);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_LE(relative_difference(out[3 + c], 0.8 * out[c]), 3e-7);
}

}  // namespace
}  // namespace likeness::brdf
