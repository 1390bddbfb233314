#include "brdf/lighting/zone.h"

#include <limits>

#include "brdf/lighting/evaluators.h"
#include "tests/brdf/evaluator_row.h"

// Seventeen exposure zones of one stop.
namespace likeness::brdf {
namespace {

template <class S>
class Zone : public ::testing::Test {
 protected:
  static std::vector<double> of(double luminance, double grey = 0.18, double grey_zone = 5) {
    return evaluate_row<ExposureZone, S>({luminance, grey, grey_zone});  // zone, index, ev
  }
  static constexpr double kTolerance = kIsFloat<S> ? 4e-6 : 1e-14;
};
TYPED_TEST_SUITE(Zone, Kinds, KindNames);

TYPED_TEST(Zone, OfMiddleGreyIsFive) {
  EXPECT_NEAR(this->of(0.18)[0], 5, this->kTolerance);
  EXPECT_EQ(this->of(0.18)[1], 5);
  EXPECT_NEAR(this->of(0.18)[2], 0, this->kTolerance);
}

TYPED_TEST(Zone, RisesByOneEveryStop) {
  for (int zone = 0; zone < Zones::kCount; ++zone) {
    const double ev = zone - 5, middle = 0.18 * std::exp2(ev);
    EXPECT_NEAR(this->of(middle)[0], zone, this->kTolerance);
    EXPECT_NEAR(this->of(middle)[2], ev, this->kTolerance);
    for (const double within : {-0.49, -0.2, 0.0, 0.3, 0.49}) EXPECT_EQ(this->of(middle * std::exp2(within))[1], zone);
  }
}

TYPED_TEST(Zone, EndsAtZeroAndSixteen) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double dark : {nan, -inf, -1.0, -0.0, 0.0, 1e-45, 1e-38, 1e-9}) {
    EXPECT_EQ(this->of(dark)[1], 0) << dark;
    EXPECT_TRUE(std::isfinite(this->of(dark)[0]) && this->of(dark)[0] < 0) << dark;
  }
  for (const double bright : {400.0, 1e9, 3e38, inf}) {
    EXPECT_EQ(this->of(bright)[1], 16) << bright;
    EXPECT_TRUE(std::isfinite(this->of(bright)[0])) << bright;
  }
}

TYPED_TEST(Zone, IsContinuousAndRises) {
  double before = -1000;
  for (double e = -80; e < 80; e += 0.01) {
    const double now = this->of(std::exp(e))[0];
    EXPECT_GE(now, before);
    EXPECT_LE(now, before < -900 ? now : before + 0.0145) << e;  // 0.01 / ln 2
    before = now;
  }
}

TYPED_TEST(Zone, CanBeNumberedSymmetrically) {
  EXPECT_EQ(this->of(0.18, 0.18, 8)[1], 8);
  EXPECT_EQ(this->of(0.18 / 256, 0.18, 8)[1], 0);
  EXPECT_EQ(this->of(0.18 * 256, 0.18, 8)[1], 16);
  EXPECT_EQ(this->of(1, 0.5, 5)[1], 6) << "another grey";
}

TYPED_TEST(Zone, HasALuminanceInItsMiddle) {
  for (const double zone : {-3.0, 0.0, 5.0, 7.5, 16.0}) {
    const auto luminance =
        luminance_of_zone(constant<TypeParam>(zone), constant<TypeParam>(0.18), constant<TypeParam>(5));
    EXPECT_NEAR(first(zone_of(luminance, constant<TypeParam>(0.18), constant<TypeParam>(5))), zone,
                2 * this->kTolerance);
  }
}

}  // namespace
}  // namespace likeness::brdf
