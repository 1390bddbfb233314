#include "brdf/fresnel/dielectric.h"

#include "brdf/fresnel/evaluators.h"
#include "tests/brdf/evaluator_row.h"

// Fresnel reflectance between transparent media.
namespace likeness::brdf {
namespace {

template <class S>
class Dielectric : public ::testing::Test {
 protected:
  static double f(double cos_i, double eta) { return first(fresnel_dielectric(constant<S>(cos_i), constant<S>(eta))); }
  static constexpr double kEpsilon = kIsFloat<S> ? 6e-8 : 1.2e-16;  // half an ulp of 1
};
TYPED_TEST_SUITE(Dielectric, Kinds, KindNames);

// Snell and Fresnel as textbooks have them.
long double textbook(long double cos_i, long double eta) {
  const long double sin2_t = (1 - cos_i * cos_i) / (eta * eta);
  if (sin2_t >= 1) return 1;
  const long double cos_t = std::sqrt(1 - sin2_t);
  const long double s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  const long double p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  return (s * s + p * p) / 2;
}

TYPED_TEST(Dielectric, MeetsItsFile) {
  if (read_reference("fresnel_dielectric.csv").empty()) GTEST_SKIP() << "no reference/fresnel_dielectric.csv";
  const double worst = worst_against_file<FresnelDielectric, TypeParam>("fresnel_dielectric.csv", {});
  this->RecordProperty("worst", std::to_string(worst));
  EXPECT_LE(worst, kIsFloat<TypeParam> ? 1e-6 : 2e-15);  // measured 3.5e-7 and 4.7e-16; the demand is 2e-5 and 1e-12
}

TYPED_TEST(Dielectric, IsTheTextbooksFormula) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto c = float(random.uniform()), n = float(random.uniform(0.3, 3));
    if (std::abs(n - 1) < 0.05) continue;  // where the textbook cancels
    const double want = double(textbook(c, n));
    // Float: the critical angle amplifies a rounding of cos, and here nothing is prepared in double.
    EXPECT_NEAR(this->f(c, n), want, kIsFloat<TypeParam> ? 2e-6 : 2e-15) << c << " " << n;
  }
}

TYPED_TEST(Dielectric, KeepsItsDigitsWhereTheIndicesAreNearlyEqual) {
  for (const double difference : {1e-2, 1e-3, 1e-4}) {
    const double n = double(float(1 + difference)), r = (n - 1) / (n + 1);
    EXPECT_NEAR(this->f(1, n) / (r * r), 1, 8 * this->kEpsilon) << difference;
  }
}

TYPED_TEST(Dielectric, ReflectsEverythingAtGrazing) {
  for (const double n : {0.05, 0.5, 0.999, 1.001, 1.33, 2.4, 20.0}) {
    EXPECT_EQ(this->f(0, n), 1) << n;
    EXPECT_LE(this->f(1e-7, n), 1) << n;
  }
  // 1 - F = 2 cos (n^2 + 1) / sqrt(n^2 - 1) + O(cos^2), from the transmittances of both polarisations.
  for (const double n : {1.1, 1.5, 2.4})
    EXPECT_NEAR((1 - this->f(1e-3, n)) / (2e-3 * (n * n + 1) / std::sqrt(n * n - 1)), 1, 0.02) << n;
}

TYPED_TEST(Dielectric, ReflectsNothingWhereThereIsNoBoundary) {
  for (const double c : {0.0, 1e-30, 1e-18, 1e-7, 0.3, 1.0}) EXPECT_EQ(this->f(c, 1), 0) << c;
}

TYPED_TEST(Dielectric, GoesIntoTotalReflectionWithoutAJump) {
  using Number = typename Arithmetic<TypeParam>::Number;
  for (const double n : {1 / 1.55, 0.5, 0.9, 0.99}) {
    auto c = Number(std::sqrt(1 - n * n) * (1 + (kIsFloat<TypeParam> ? 1e-5 : 1e-13)));
    double before = this->f(double(c), double(Number(n)));
    for (int step = 0; step < (kIsFloat<TypeParam> ? 400 : 2000); ++step) {
      c = std::nextafter(c, Number(0));
      const double now = this->f(double(c), double(Number(n)));
      // The curve ends vertically: over one ulp it may rise by the root of one, times 2 (n + 1/n) / sin.
      ASSERT_NEAR(now, before, 12 * std::sqrt(2 * this->kEpsilon)) << n;
      ASSERT_GE(now, before - 8 * this->kEpsilon) << "F rises towards total reflection";
      before = now;
    }
    EXPECT_EQ(before, 1) << n;
  }
}

// Numbers of 31 bits have squares of 62, which long double adds without a rounding: the reference knows g^2 exactly.
TEST(DielectricInDouble, KeepsTwelveDigitsAtTheCriticalAngle) {
  for (const double about : {1 / 1.55, 0.5, 0.77, 0.99}) {
    const long double n = std::ldexp(std::round(std::ldexp(about, 31)), -31);
    for (const int ulps : {1, 2, 5, 100, 100000}) {
      const long double c = std::ldexp(std::ceil(std::ldexp(std::sqrt(1 - n * n), 31)) + ulps, -31);
      const long double g = std::sqrt(n * n - 1 + c * c);
      const long double s = (c - g) / (c + g), p = (n * n * c - g) / (n * n * c + g);
      EXPECT_NEAR(fresnel_dielectric(double(c), double(n)), double((s * s + p * p) / 2), 2e-15) << about << " " << ulps;
    }
  }
}

TYPED_TEST(Dielectric, IsTheSameFromEitherSide) {  // Stokes: F at cos_i into n is F at cos_t into 1 / n
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const double n = random.uniform(1.1, 3), c = random.uniform(0.05, 1);
    const double cos_t = std::sqrt(1 - (1 - c * c) / (n * n));
    const double there = this->f(c, n), back = this->f(cos_t, 1 / n);
    EXPECT_NEAR(there, back, kIsFloat<TypeParam> ? 2e-5 : 2e-13) << c << " " << n;
  }
}

TYPED_TEST(Dielectric, TakesACosineBelowZeroAsARayFromBehind) {
  for (const double n : {0.7, 1.5, 2.4})
    for (const double c : {1.0, 0.9, 0.5, 1e-3, 1e-7})
      EXPECT_NEAR(this->f(-c, n), this->f(c, double(typename Arithmetic<TypeParam>::Number(1 / n))),
                  kIsFloat<TypeParam> ? 1e-6 : 1e-15)
          << n << " " << c;
  EXPECT_EQ(this->f(-0.0, 1.5), 1);
  EXPECT_NEAR(this->f(-1.5, 1.5), 0.04, 1e-7) << "beyond the range: as at its end";
  EXPECT_NEAR(this->f(1.5, 1.5), 0.04, 1e-7);
}

TYPED_TEST(Dielectric, StaysBetweenNothingAndEverything) {
  Random random(3);
  const auto edge = [&](std::initializer_list<double> edges, double low, double high) {
    return random.uniform() < 0.5 ? edges.begin()[random.index(edges.size())] : random.uniform(low, high);
  };
  for (int i = 0; i < 100000; ++i) {
    const double c = edge({0, 1, -1, 1e-7, -1e-7, 1e-19, 1e-38, 1e-45, 0.5}, -1, 1);
    const double n = edge({1, 0.05, 20, 1.0000001, 0.9999999, 1.5}, 0.05, 3);
    const double f = this->f(c, n);
    ASSERT_TRUE(f >= 0 && f <= 1) << f << " at " << c << ", " << n;
  }
}

TYPED_TEST(Dielectric, RisesTowardsGrazing) {
  for (const double n : {1.05, 1.5, 2.4, 0.66, 0.4}) {
    double before = 0;
    for (int i = 200; i >= 0; --i) {
      const double now = this->f(i / 200.0, n);
      EXPECT_GE(now, before - 8 * this->kEpsilon) << n << " " << i;
      before = now;
    }
  }
}

}  // namespace
}  // namespace likeness::brdf
