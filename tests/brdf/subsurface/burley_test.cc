#include <numbers>

#include "brdf/subsurface/evaluators.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/subsurface/profile_errors.h"

// Burley's profile, its CDF and the inverse.
namespace likeness::brdf {
namespace {

using Long = long double;
constexpr double kScales[]{1e-6, 1e-3, 0.5, 1, 30, 1e6};

// The formulas as the paper prints them.
Long printed_profile(Long r, Long s) {
  return s * (std::exp(-s * r) + std::exp(-s * r / 3)) / (8 * std::numbers::pi_v<Long> * r);
}
// Newton's method in long double, on u or on 1 - u, whichever is smaller.
Long inverse(Long u, Long rest) {
  Long x = u < 0.5L ? 2 * u : 3 * std::log(0.75L / rest);
  for (int i = 0; i < 60; ++i) {
    const Long e = std::exp(-x / 3), slope = (e * e * e + e) / 4;
    const Long inside = -(std::expm1(-x) + 3 * std::expm1(-x / 3)) / 4, outside = (e * e * e + 3 * e) / 4;
    x += (u < 0.5L ? u - inside : outside - rest) / slope;
  }
  return x;
}

template <class S>
class Burley : public ::testing::Test {
 protected:
  // Relative errors: 1e-14 in double (7e-16 measured for the inverse), 2e-6 in float (4e-7 measured).
  static constexpr double kNear = kIsFloat<S> ? 2e-6 : 1e-14;
};
TYPED_TEST_SUITE(Burley, Kinds, KindNames);

TYPED_TEST(Burley, InverseMeetsItsFile) {
  if (read_reference("burley_icdf.csv").empty()) GTEST_SKIP() << "no " LIKENESS_SHARED_DIR "/reference/burley_icdf.csv";
  worst_against_file<BurleyIcdf, TypeParam>("burley_icdf.csv", {});
}

TYPED_TEST(Burley, SlabTransmissionMeetsItsFile) {
  if (read_reference("slab_transmission.csv").empty())
    GTEST_SKIP() << "no " LIKENESS_SHARED_DIR "/reference/slab_transmission.csv";
  worst_against_file<SlabTransmission, TypeParam>("slab_transmission.csv", {});
}

TYPED_TEST(Burley, ProfileAndDensitiesAreAsPrinted) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const double s = std::exp(random.uniform(-13.8, 13.8)), x = std::exp(random.uniform(-25, 4)), a = random.uniform();
    const auto got = evaluate_row<BurleyProfile, TypeParam>({x / s, s, a});
    const Long r = Long(x) / s, want = printed_profile(r, s);
    // exp(-x / 3) of a rounded x: x / 3 roundings, 55 of them at most.
    const double near = (kIsFloat<TypeParam> ? 6e-8 : 1.1e-16) * (8 + x);
    ASSERT_LE(relative_difference(got[0], double(a * want)), near) << "r " << x / s << " s " << s;
    ASSERT_LE(relative_difference(got[1], double(2 * std::numbers::pi_v<Long> * r * want)), near);
    ASSERT_LE(relative_difference(got[2], double(want)), near);
  }
}

TYPED_TEST(Burley, ProfileIsHeldNearTheOriginWithoutAJump) {
  for (const double s : kScales) {
    const auto at = [&](double r) { return evaluate_row<BurleyProfile, TypeParam>({r, s, 0.8})[0]; };
    const double held = 0.8 * s * s * 2 / (8 * std::numbers::pi * kBurleyLeastX);
    EXPECT_LE(relative_difference(at(0), held), 1e-6) << s;                           // rounding in float
    EXPECT_LE(relative_difference(at(0), at(0.99 * kBurleyLeastX / s)), 2e-12) << s;  // the exponentials still move
    EXPECT_LE(relative_difference(at(0), at(1.000001 * kBurleyLeastX / s)), 2e-6) << s;
    EXPECT_LE(relative_difference(at(2 * kBurleyLeastX / s), at(0) / 2), 1e-6) << s;
  }
}

TYPED_TEST(Burley, ProfileFallsAllTheWay) {
  for (const double s : {1e-6, 1.0, 1e6}) {
    double before = std::numeric_limits<double>::infinity();
    for (int i = -200; i < 60; ++i) {
      const double now = evaluate_row<BurleyProfile, TypeParam>({std::pow(10, i / 20.0) / s, s, 1})[0];
      ASSERT_TRUE(now >= 0 && (now < before || now == 0)) << "s " << s << ", step " << i;
      before = now;
    }
    EXPECT_EQ((evaluate_row<BurleyProfile, TypeParam>({1e9, 1e6, 1})[0]), 0);
  }
}

TYPED_TEST(Burley, CdfKeepsItsDigitsAtBothEnds) {
  for (const double s : kScales)
    for (int i = -300; i <= 40; ++i) {
      const double x = std::pow(10, i / 20.0);
      const auto got = evaluate_row<BurleyCdf, TypeParam>({x / s, s});
      const Long r = Long(x / s) * s;
      const double inside = double(-(std::expm1(-r) + 3 * std::expm1(-r / 3)) / 4);
      const double outside = double((std::exp(-r) + 3 * std::exp(-r / 3)) / 4);
      ASSERT_LE(relative_difference(got[0], inside), this->kNear) << "x " << x;
      ASSERT_LE(relative_difference(got[1], outside), this->kNear * (1 + x / 9)) << "x " << x;  // exp of a rounded x
    }
  EXPECT_EQ((evaluate_row<BurleyCdf, TypeParam>({0, 1})[0]), 0);
  EXPECT_EQ((evaluate_row<BurleyCdf, TypeParam>({0, 1})[1]), 1);
  EXPECT_EQ((evaluate_row<BurleyCdf, TypeParam>({1e9, 1e6})[0]), 1);
  EXPECT_EQ((evaluate_row<BurleyCdf, TypeParam>({1e9, 1e6})[1]), 0);
}

// u given as itself where it is small and as 1 - u where that is: the features that prepare() makes.
template <class S>
double icdf_in(double u, double rest) {
  return first(burley_icdf(constant<S>(u), constant<S>(rest)));
}

TYPED_TEST(Burley, InverseIsRightToTheLastDigitsFromEndToEnd) {
  for (int i = 0; i <= 3000; ++i) {
    const double part = std::pow(10, -0.01 * i) * 0.5;  // from 1/2 down to 5e-31
    const double near_origin = double(inverse(part, 1 - Long(part)));
    ASSERT_LE(relative_difference(icdf_in<TypeParam>(part, 1 - part), near_origin), this->kNear) << "u " << part;
    if (part < 1e-30) continue;
    const double far = double(inverse(1 - Long(part), part));
    ASSERT_LE(relative_difference(icdf_in<TypeParam>(1 - part, part), far), this->kNear) << "1 - u " << part;
  }
}

TYPED_TEST(Burley, InverseIsFiniteAtItsEndsForEveryShape) {
  const double last = kIsFloat<TypeParam> ? 1 - 0x1p-24 : 1 - 0x1p-53;
  for (const double s : kScales) {
    const auto at = [&](double u) { return evaluate_row<BurleyIcdf, TypeParam>({u, s})[0]; };
    EXPECT_EQ(at(0), 0) << s;
    for (const double u : {1 - 0x1p-24, last}) {
      const double want = double(inverse(u, 1 - Long(u)) / s);
      EXPECT_LE(relative_difference(at(u), want), this->kNear) << "u " << u << " s " << s;
    }
    EXPECT_GT(at(1), at(last)) << s;
    EXPECT_LE(relative_difference(at(1), 3 * std::log(0.75e30) / s), 2e-6) << s;  // counts as 1 - 1e-30
  }
}

TYPED_TEST(Burley, CdfOfTheInverseIsWhatWasAskedFor) {
  using S = TypeParam;
  for (int i = 0; i <= 500; ++i) {
    const double part = std::pow(10, -0.05 * i) * 0.5, s = kScales[i % 6];
    // Through r and back, so that s takes part.
    const S near = constant<S>(s) * S(burley_icdf(constant<S>(part), constant<S>(1 - part)) / constant<S>(s));
    ASSERT_LE(relative_difference(first(burley_cdf(near)), part), this->kNear) << part;
    const S far = constant<S>(s) * S(burley_icdf(constant<S>(1 - part), constant<S>(part)) / constant<S>(s));
    // An error of x by 4e-7 is one of exp(-x / 3) by x / 3 as much.
    ASSERT_LE(relative_difference(first(burley_beyond(far)), part), this->kNear * (1 + first(far) / 3)) << part;
  }
}

TEST(Burley, DensityIsTheSlopeOfTheCdf) {
  for (const Long s : {1e-6L, 0.7L, 1e6L})
    for (int i = -60; i <= 40; ++i) {
      const Long r = std::pow(10.0L, i / 20.0L) / s, step = r * 1e-5L;
      const Long low = (r - step) * s, high = (r + step) * s;  // of the rest, where the CDF has lost its digits
      const Long rise = r * s < 1 ? burley_cdf(high) - burley_cdf(low) : burley_beyond(low) - burley_beyond(high);
      const Long slope = rise / (2 * step);
      // Truncation: (x 1e-5)^2 / 54, 2e-8 at x = 100.
      EXPECT_LE(relative_difference(double(burley_density_over_radius(r, s)), double(slope)), 1e-7) << double(r * s);
      EXPECT_LE(relative_difference(double(2 * std::numbers::pi_v<Long> * r * burley_density_over_area(r, s)),
                                    double(burley_density_over_radius(r, s))),
                1e-15);  // the same sum, multiplied in another order
    }
}

TEST(Burley, ProfileIntegratesToItsAlbedo) {
  for (const double s : kScales) {
    double over_radius = 0, over_plane = 0;
    for (const Node& node : radial_nodes()) {
      const double r = node.x / s, weight = node.weight / s;
      over_radius += weight * burley_density_over_radius(r, s);
      over_plane += weight * 2 * std::numbers::pi * r * burley_profile(r, s, 0.8);
    }
    EXPECT_NEAR(over_radius, 1, 1e-12);   // what lies beyond x = 90: 1e-13
    EXPECT_NEAR(over_plane, 0.8, 1e-12);  // the same
  }
}

TEST(Burley, ShapesAreThoseOfThePaper) {
  for (const double a : {0.0, 0.1, 0.33, 0.5, 0.8, 0.95, 1.0}) {
    EXPECT_NEAR(burley_shape_searchlight(a), 1.85 - a + 7 * std::pow(std::abs(a - 0.8), 3), 1e-14);  // rounding
    EXPECT_NEAR(burley_shape_diffuse(a), 1.9 - a + 3.5 * std::pow(a - 0.8, 2), 1e-14);
    EXPECT_NEAR(burley_shape_dmfp(a), 3.5 + 100 * std::pow(a - 0.33, 4), 1e-13);
  }
  EXPECT_DOUBLE_EQ(burley_shape_searchlight(0.8), 1.05);
  EXPECT_DOUBLE_EQ(burley_shape_diffuse(0.8), 1.1);
  EXPECT_DOUBLE_EQ(burley_shape_dmfp(0.33), 3.5);
}

// ---- Halley's method.

// The table on docs/models/burley_profile.md.
TEST(Halley, ErrorsAreThoseOfThePage) {
  const auto error = [](int steps, double u) {
    double x = burley_halley_start(u);
    for (int i = 0; i < steps; ++i) x = burley_halley_step(x, u, 1 - u);
    return std::abs(x / burley_icdf(u, 1 - u) - 1);
  };
  EXPECT_NEAR(error(1, 0.5), 9.3e-4, 0.05e-4);
  EXPECT_NEAR(error(1, 0.9), 9.9e-4, 0.05e-4);
  EXPECT_NEAR(error(2, 0.99), 1.3e-4, 0.05e-4);
  EXPECT_LE(error(2, 0.9), 1e-9);
  EXPECT_LE(error(3, 0.95), 1e-15 * 4);
  EXPECT_NEAR(error(4, 1 - 0x1p-24), 0.33, 0.01);
}

TYPED_TEST(Burley, HalleyIsFiniteAndGrowsInEveryScalar) {
  for (int steps = 1; steps <= 4; ++steps) {
    double before = -1;
    for (const double u : {0.0, 1e-30, 1e-12, 1e-6, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.999, 1 - 0x1p-24, 1.0}) {
      const double r = evaluate_row<BurleyIcdfHalley, TypeParam>({u, 2, double(steps)})[0];
      ASSERT_TRUE(std::isfinite(r) && r >= before) << "steps " << steps << ", u " << u;
      before = r;
    }
    EXPECT_EQ((evaluate_row<BurleyIcdfHalley, TypeParam>({0, 2, double(steps)})[0]), 0);
  }
}

TYPED_TEST(Burley, HalleyOfFourStepsIsTheInverseOverMostOfTheRange) {
  for (int i = 0; i <= 990; ++i) {
    const double u = i / 1000.0;
    const double want = evaluate_row<BurleyIcdf, TypeParam>({u, 3})[0];
    ASSERT_LE(relative_difference(evaluate_row<BurleyIcdfHalley, TypeParam>({u, 3, 4})[0], want), this->kNear) << u;
  }
}

template <class S, int kSteps>
void expect_same_steps() {
  for (const double u : {0.0, 0.2, 0.6, 0.995})
    EXPECT_EQ((evaluate_row<BurleyIcdfHalley, S>({u, 2, double(kSteps)})),
              (evaluate_row<BurleyIcdfHalleySteps<kSteps>, S>({u, 2})));
}
TYPED_TEST(Burley, TheNumberOfStepsMayBeAnInput) {
  expect_same_steps<TypeParam, 1>();
  expect_same_steps<TypeParam, 2>();
  expect_same_steps<TypeParam, 3>();
  expect_same_steps<TypeParam, 4>();
}

}  // namespace
}  // namespace likeness::brdf
