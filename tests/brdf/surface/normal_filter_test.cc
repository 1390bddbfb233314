#include "brdf/normal_length.h"
#include "tests/brdf/kinds.h"

// The arithmetic of mip maps: shortened normals, their mean, and what it stands for.
namespace likeness::brdf {
namespace {

template <class S>
class NormalFilterIn : public ::testing::Test {};
TYPED_TEST_SUITE(NormalFilterIn, Kinds, KindNames);

TYPED_TEST(NormalFilterIn, OneTexelComesBack) {
  using S = TypeParam;
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const auto n = random.direction(-1);
    const double roughness = i % 5 ? random.uniform(0.1, 1) : 1;
    ShortenedNormals<S> sum;
    for (int k = 0; k < 4; ++k) sum.add(vector_in<S>(n), constant<S>(roughness), constant<S>(0.25 * (k + 1)));
    const FilteredNormal<S> got = sum.filtered();
    // A length is known to its rounding, 1e-16 or 6e-8, which is 1 - length = 2e-4 at roughness 0.1 off by so much.
    EXPECT_NEAR(first(got.roughness), roughness, kIsFloat<S> ? 1e-4 : 1e-12) << i;
    EXPECT_NEAR(first(got.normal.x), n.x, kIsFloat<S> ? 2e-7 : 4e-16);
    EXPECT_NEAR(first(got.normal.y), n.y, kIsFloat<S> ? 2e-7 : 4e-16);
    EXPECT_NEAR(first(got.normal.z), n.z, kIsFloat<S> ? 2e-7 : 4e-16);
  }
}

TYPED_TEST(NormalFilterIn, TwoNormalsMakeARougherOneBetweenThem) {
  using S = TypeParam;
  double last = 0.3;
  for (const double tilt : {0.1, 0.2, 0.4, 0.6}) {
    ShortenedNormals<S> sum;
    for (const double side : {-1.0, 1.0})
      sum.add(vector_in<S>({side * std::sin(tilt), 0, std::cos(tilt)}), constant<S>(0.3));
    const FilteredNormal<S> got = sum.filtered();
    EXPECT_NEAR(first(got.normal.z), 1, 1e-7);
    EXPECT_NEAR(first(got.length), std::cos(tilt) * normal_length(0.09), 2e-7);  // the cosines are left of either
    EXPECT_GT(first(got.roughness), last) << tilt;
    last = first(got.roughness);
  }
}

TYPED_TEST(NormalFilterIn, WhatCancelsIsAsRoughAsGgxCanBe) {
  using S = TypeParam;
  ShortenedNormals<S> sum;
  sum.add(vector_in<S>({1, 0, 0}), constant<S>(0));
  sum.add(vector_in<S>({-1, 0, 0}), constant<S>(0));
  const FilteredNormal<S> got = sum.filtered();
  EXPECT_EQ(first(got.roughness), 1);
  EXPECT_EQ(first(got.length), 0);
  EXPECT_EQ(first(got.normal.z), 1);
  EXPECT_EQ(first(got.normal.x), 0);
  // And a spread wider than any GGX: three axes, length 1 / sqrt 3.
  ShortenedNormals<S> axes;
  axes.add(vector_in<S>({1, 0, 0}), constant<S>(0));
  axes.add(vector_in<S>({0, 1, 0}), constant<S>(0));
  axes.add(vector_in<S>({0, 0, 1}), constant<S>(0));
  EXPECT_EQ(first(axes.filtered().roughness), 1);
  EXPECT_NEAR(first(axes.filtered().length), 1 / std::sqrt(3.0), 1e-7);
}

// A mip of a mip is the mip of all, if the means are handed on and not the pair of normal and roughness: and as that pair
// as well, as long as nothing is clamped.
TEST(NormalFilter, LevelsMayBeMadeFromOneAnother) {
  Random random(3);
  ShortenedNormals<double> all, of_four[4], of_pairs;
  for (int i = 0; i < 16; ++i) {
    const auto n = random.direction(0.8);
    const double roughness = random.uniform(0.2, 0.6);
    all.add(n, roughness);
    of_four[i / 4].add(n, roughness);
  }
  for (const auto& four : of_four) of_pairs.add(four.filtered().normal, four.filtered().roughness);
  const auto at_once = all.filtered(), in_steps = of_pairs.filtered();
  EXPECT_NEAR(at_once.roughness, in_steps.roughness, 1e-13);
  EXPECT_NEAR(at_once.normal.x, in_steps.normal.x, 1e-15);
}

// A smooth surface whose normals are those of GGX is GGX from afar.
TEST(NormalFilter, SmoothBumpsWithTheNormalsOfGgxBecomeThatGgx) {
  for (const double roughness : {0.2, 0.5, 0.8, 1.0}) {
    const double alpha = roughness * roughness;
    ShortenedNormals<double> sum;
    const int rings = 20000;
    for (int i = 0; i < rings; ++i) {
      // Equal shares of the flat surface: tan^2 theta = alpha^2 u / (1 - u).
      const double u = (i + 0.5) / rings, t = alpha * std::sqrt(u / (1 - u)), c = 1 / std::sqrt(1 + t * t);
      for (int k = 0; k < 4; ++k) sum.add(Random::direction_at(c, k * std::numbers::pi / 2 + 0.3), 0.0);
    }
    EXPECT_NEAR(sum.filtered().roughness, roughness, 2e-4) << roughness;  // the rule near u = 1: 1e-4 measured
    EXPECT_NEAR(sum.filtered().normal.z, 1, 1e-12);
  }
}

// Roughness adds: bumps of one alpha under a rougher microsurface look rougher than either.
TEST(NormalFilter, RoughnessOfTheTexelsStaysIn) {
  const auto bumps = [](double roughness) {
    ShortenedNormals<double> sum;
    for (const double x : {-0.3, 0.3}) sum.add({x, 0, std::sqrt(1 - x * x)}, roughness);
    return sum.filtered().roughness;
  };
  EXPECT_GT(bumps(0.5), bumps(0));
  EXPECT_GT(bumps(0.5), 0.5);
  EXPECT_GT(bumps(0), 0.3);
}

}  // namespace
}  // namespace likeness::brdf
