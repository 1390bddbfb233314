#include "brdf/lighting/compressed_harmonics.h"

#include "brdf/lighting/evaluators.h"
#include "tests/brdf/evaluator_row.h"

// Spherical harmonics relative to band 0.
namespace likeness::brdf {
namespace {

template <class S>
class Compressed : public ::testing::Test {
 protected:
  static constexpr double kTolerance = kIsFloat<S> ? 4e-7 : 1e-15;
};
TYPED_TEST_SUITE(Compressed, Kinds, KindNames);

template <class S>
Sh<S> light_from(const Vec3<double>& direction, double power) {
  Sh<S> out;
  out.add(vector_in<S>(direction), constant<S>(power));
  return out;
}

// Lights from a few directions: nowhere negative before it is projected.
Sh<double> random_lights(Random& random) {
  Sh<double> out;
  for (std::size_t i = 0; i <= random.index(4); ++i) out.add(random.direction(-1), random.uniform(0, 10));
  return out;
}

TYPED_TEST(Compressed, ReachesItsBoundsForOneLight) {
  const double h = std::sqrt(0.5);
  const std::vector<std::pair<Vec3<double>, std::size_t>> extremes{{{0, 1, 0}, 0}, {{0, 0, 1}, 1}, {{1, 0, 0}, 2},
                                                                   {{h, h, 0}, 3}, {{0, h, h}, 4}, {{0, 0, 1}, 5},
                                                                   {{h, 0, h}, 6}, {{1, 0, 0}, 7}};
  for (const auto& [d, i] : extremes) {
    const CompressedSh<TypeParam> c(light_from<TypeParam>(d, 7));
    EXPECT_NEAR(first(c.e[i]), 1, this->kTolerance) << i;
  }
}

TYPED_TEST(Compressed, HoldsEveryLightWithoutClamping) {
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const Sh<double> want = random_lights(random);
    Sh<TypeParam> in;
    for (std::size_t k = 0; k < kShCount; ++k) in.c[k] = constant<TypeParam>(want.c[k]);
    const CompressedSh<TypeParam> c(in);
    const Sh<TypeParam> back = c.expanded();
    for (std::size_t k = 0; k < kShCount; ++k)
      ASSERT_NEAR(first(back.c[k]), want.c[k], 8 * this->kTolerance * want.c[0]) << k;
    for (const TypeParam& e : c.e) ASSERT_TRUE(first(e) >= 0 && first(e) <= 1);
  }
}

TYPED_TEST(Compressed, InEightBitsLosesLessThanOnePercentOfBandZero) {
  Random random(2);
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    const Sh<double> want = random_lights(random);
    Sh<TypeParam> in;
    for (std::size_t k = 0; k < kShCount; ++k) in.c[k] = constant<TypeParam>(want.c[k]);
    const Sh<TypeParam> back = CompressedSh<TypeParam>(in).rounded_to_levels().expanded();
    for (std::size_t k = 1; k < kShCount; ++k)
      ASSERT_LE(std::abs(first(back.c[k]) - want.c[k]),
                want.c[0] * (CompressedSh<double>::bound(k - 1) / 254 + 4 * this->kTolerance))
          << k;
    const Vec3<double> d = random.direction(-1);
    worst =
        std::max(worst, std::abs(first(back.eval(vector_in<TypeParam>(d))) - want.eval(d)) / (want.c[0] * sh::kBand0));
  }
  EXPECT_LE(worst, 0.05);  // measured 0.039 of the mean radiance, all eight errors together
  EXPECT_GE(worst, 0.01) << "nothing was rounded: the test has lost its point";
}

TYPED_TEST(Compressed, HoldsFaintLightAsItHoldsStrong) {
  for (const double power : {1e-33, 1e-20, 1e20}) {
    const CompressedSh<TypeParam> c(light_from<TypeParam>({0.6, 0, 0.8}, power));
    EXPECT_NEAR(first(c.e[2]), 0.5 + 0.3, 2 * this->kTolerance) << power;
    EXPECT_NEAR(first(c.e[1]), 0.5 + 0.4, 2 * this->kTolerance) << power;
  }
}

TYPED_TEST(Compressed, LeavesAmbientLightAmbient) {
  for (const double c0 : {1e-30, 1e-6, 1.0, 1e4}) {
    Sh<TypeParam> ambient;
    ambient.c[0] = constant<TypeParam>(c0);
    const Sh<TypeParam> back = CompressedSh<TypeParam>(ambient).rounded_to_levels().expanded();
    for (std::size_t k = 1; k < kShCount; ++k) EXPECT_EQ(first(back.c[k]), 0) << k;
  }
}

TYPED_TEST(Compressed, OfNoLightIsNoLight) {
  for (const double c0 : {0.0, -1.0, 1e-45}) {
    Sh<TypeParam> dark;
    dark.c[0] = constant<TypeParam>(c0);
    dark.c[3] = constant<TypeParam>(0.5);  // what ringing may leave
    const CompressedSh<TypeParam> c(dark);
    for (const TypeParam& e : c.e) EXPECT_EQ(first(e), c0 == 1e-45 && !kIsFloat<TypeParam> ? first(e) : 0.5);
    for (const TypeParam& x : c.expanded().c) EXPECT_NEAR(first(x), 0, 1e-44);
  }
}

TYPED_TEST(Compressed, ClampsWhatNoLightCanBe) {
  const auto out = evaluate_row<ShCompressed, TypeParam>({1, 5, -5, 0, 9, -9, 0, 0, 1});
  const double want[]{1, 1, 0, 0.5, 1, 0, 0.5, 0.5, 0.5 + 0.5 / (std::sqrt(15) / 2)};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(out[i], want[i], this->kTolerance) << i;
}

}  // namespace
}  // namespace likeness::brdf
