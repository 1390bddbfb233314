#include "brdf/realis/coefficient.h"

#include <cmath>
#include <limits>

#include "tests/brdf/kinds.h"

// Coefficients in eight bits.
namespace likeness::brdf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Coefficient, ComesBackAsTheNearestByte) {
  for (const double multiplier : {1e-30, 0.003, 1.0, 700.0})
    for (int byte = 1; byte <= 255; ++byte) {
      EXPECT_EQ(encoded(decoded(double(byte), multiplier), multiplier), byte) << multiplier;
      const double beside = multiplier * (byte - 128 + 0.49) / 127;
      EXPECT_EQ(encoded(beside, multiplier), byte) << multiplier;
    }
}

TEST(Coefficient, IsOffByHalfAStepAtMost) {
  Random random(3);
  for (int i = 0; i < 100000; ++i) {
    const double multiplier = std::exp(random.uniform(-20, 8)), c = multiplier * random.uniform(-1, 1);
    const double back = decoded(double(encoded(c, multiplier)), multiplier);
    ASSERT_LE(std::abs(back - c), multiplier / 254 * (1 + 1e-12)) << c << " of " << multiplier;
    ASSERT_EQ(encoded(-c, multiplier) - 128, 128 - encoded(c, multiplier)) << "signs are alike";
  }
}

TEST(Coefficient, ThatExceedsTheMultiplierIsClippedAndNoByteIsZero) {
  for (const double c : {1.0001, 5.0, 1e300, kInfinity}) {
    EXPECT_EQ(encoded(c, 1), 255);
    EXPECT_EQ(encoded(-c, 1), 1);
  }
}

TEST(Coefficient, OfNothingIsNothing) {
  EXPECT_EQ(encoded(kNan, 1), 128);
  for (const double multiplier : {0.0, -1.0, kNan})
    for (const double c : {0.0, 1.0, -1.0, kNan, kInfinity}) EXPECT_EQ(encoded(c, multiplier), 128) << multiplier;
  EXPECT_EQ(encoded(0, 3), 128);
  EXPECT_EQ(encoded(-0.0, 3), 128);
  EXPECT_EQ(encoded(kInfinity, kInfinity), 128);
}

template <class S>
class StoredCoefficient : public ::testing::Test {};
TYPED_TEST_SUITE(StoredCoefficient, Kinds, KindNames);

TYPED_TEST(StoredCoefficient, IsExactInTheMiddleAndAtTheEndsAndFiniteEverywhere) {
  const double kLargest = kIsFloat<TypeParam> ? 1e38 : 1e308;
  const double kSmallest = kIsFloat<TypeParam> ? 1e-44 : 1e-322;  // denormal
  for (const double multiplier : {0.0, kSmallest, 0.25, kLargest}) {
    const auto at = [&](double byte) {
      return first(decoded(constant<TypeParam>(byte), constant<TypeParam>(multiplier)));
    };
    const double exact = first(constant<TypeParam>(multiplier));
    EXPECT_EQ(at(128), 0);
    EXPECT_EQ(at(255), exact);
    EXPECT_EQ(at(1), -exact);
    for (int byte = 0; byte <= 255; ++byte) {
      EXPECT_TRUE(std::isfinite(at(byte))) << byte << " of " << multiplier;
      EXPECT_NEAR(at(byte), exact * ((byte - 128) / 127.0), (kIsFloat<TypeParam> ? 2e-7 : 4e-16) * exact + kSmallest);
    }
  }
}

TEST(Multiplier, ClipsNothing) {
  Random random(8);
  EXPECT_EQ(multiplier_of(0), 0);
  for (int i = 0; i < 10000; ++i) {
    const double largest = std::exp(random.uniform(-60, 60));
    const float multiplier = multiplier_of(largest);
    ASSERT_GE(double(multiplier), largest);
    ASSERT_LE(double(multiplier), largest * (1 + 1.2e-7) + 2e-45) << "and is no larger than that";
  }
}

}  // namespace
}  // namespace likeness::brdf
