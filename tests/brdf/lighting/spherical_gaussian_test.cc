#include "brdf/lighting/spherical_gaussian.h"

#include "brdf/lighting/evaluators.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/lighting/sphere_quadrature.h"

// Gaussians on the sphere, plain and windowed.
namespace likeness::brdf {
namespace {

template <class S>
class Gaussian : public ::testing::Test {
 protected:
  static SphericalGaussian<S> lobe(const Vec3<double>& axis, double sharpness, double amplitude = 1) {
    return {vector_in<S>(axis), constant<S>(sharpness), constant<S>(amplitude)};
  }
  static double integral(double sharpness) { return first(lobe({0, 0, 1}, sharpness).integral()); }
  static double windowed(double sharpness, double versine) {
    return first(WindowedGaussian<S>{lobe({0, 0, 1}, sharpness)}.eval(constant<S>(versine)));
  }
  static double windowed_integral(double sharpness) {
    return first(WindowedGaussian<S>{lobe({0, 0, 1}, sharpness)}.integral());
  }
  static constexpr double kEpsilon = kIsFloat<S> ? 6e-8 : 1.2e-16;  // half an ulp of 1
};
TYPED_TEST_SUITE(Gaussian, Kinds, KindNames);

const std::vector<double> kSharpnesses{0, 1e-12, 1e-6, 4.9e-6, 5.1e-6, 1e-3, 0.5, 1, 2.3, 2.31, 10, 100, 1e4, 1e6};

TYPED_TEST(Gaussian, HasItsValue) {
  for (const double sharpness : kSharpnesses)
    for (const double angle : {0.0, 1e-4, 1e-3, 0.1, 1.0, std::numbers::pi / 2, std::numbers::pi}) {
      const double lambda = double(typename Arithmetic<TypeParam>::Number(sharpness));
      const double x = lambda * 2 * squared(std::sin(angle / 2)), want = 3 * std::exp(-x);
      const auto out = evaluate_row<PlainSphericalGaussian, TypeParam, ByAngle>({angle, lambda, 3});
      EXPECT_NEAR(out[0], want, (4 + 2 * x) * this->kEpsilon * want + 1e-37) << sharpness << " " << angle;
      const auto by_cosine = evaluate_row<PlainSphericalGaussian, TypeParam, ByCosine>({std::cos(angle), lambda, 3});
      EXPECT_NEAR(by_cosine[0], want, (4 + 2 * x) * this->kEpsilon * want + 3.4e-16 * lambda)
          << sharpness << " " << angle;
    }
}

TYPED_TEST(Gaussian, KeepsItsDigitsNearTheAxis) {  // 1 - dot(axis, direction) would be 0 or 6e-8 in float
  for (const double sharpness : {1e4, 1e6})
    for (const double x : {1e-4, 0.01, 0.5, 2.0, 20.0}) {
      using Number = typename Arithmetic<TypeParam>::Number;
      const double tilt = double(Number(std::sqrt(2 * x / sharpness)));
      const double cosine = double(Number(std::sqrt(1 - tilt * tilt))), rest = 1 - cosine;
      const double versine = (tilt * tilt + rest * rest) / 2, want = std::exp(-sharpness * versine);
      const double got = first(this->lobe({0, 0, 1}, sharpness).eval(vector_in<TypeParam>({tilt, 0, cosine})));
      EXPECT_NEAR(got, want, (4 + 4 * x) * this->kEpsilon * want) << sharpness << " " << x;
    }
}

TYPED_TEST(Gaussian, HasItsIntegral) {
  for (const double sharpness : kSharpnesses) {
    const long double lambda = typename Arithmetic<TypeParam>::Number(sharpness);
    const long double want =
        lambda > 0 ? -2 * std::numbers::pi * std::expm1(-2 * lambda) / lambda : 4 * std::numbers::pi;
    EXPECT_NEAR(this->integral(sharpness) / double(want), 1, 4 * this->kEpsilon) << sharpness;
  }
  const double by_quadrature = 2 * std::numbers::pi * over_interval(0, 2, [](double v) { return std::exp(-3 * v); });
  EXPECT_NEAR(this->integral(3) / by_quadrature, 1, 8 * this->kEpsilon);
}

TYPED_TEST(Gaussian, TimesAnotherIsTheirProductInEveryDirection) {
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const double la = i % 3 ? random.uniform(0, 30) : 0, lb = random.uniform(0, 30);
    const auto a = this->lobe(random.direction(-1), la, 2), b = this->lobe(random.direction(-1), lb, 0.5);
    const auto d = vector_in<TypeParam>(random.direction(-1));
    const double want = first(a.eval(d)) * first(b.eval(d)), got = first((a * b).eval(d));
    EXPECT_NEAR(got, want, 400 * this->kEpsilon * want + 1e-37) << la << " " << lb;  // exponents to 120
  }
}

TYPED_TEST(Gaussian, TimesASharpNeighbourKeepsItsDigits) {  // lambda_m - lambda_a - lambda_b is 2e6 - 2e6
  for (const double angle : {1e-4, 1e-3, 3e-3}) {
    const auto out = evaluate_row<SphericalGaussianProduct, TypeParam>({angle, 1e6, 1, 1e6, 1});
    EXPECT_NEAR(out[0] / (angle / 2), 1, 8 * this->kEpsilon) << angle;
    EXPECT_NEAR(out[1] / (2e6 * std::cos(angle / 2)), 1, 8 * this->kEpsilon) << angle;
    const double loss = 4e6 * squared(std::sin(angle / 4)) * 1;  // 2 lambda (1 - cos(angle / 2))
    EXPECT_NEAR(out[2] / std::exp(-loss), 1, (8 + 4 * loss) * this->kEpsilon) << angle;
  }
}

TYPED_TEST(Gaussian, TimesItsOppositeIsConstant) {
  for (const double sharpness : {0.0, 1e-3, 2.0, 40.0}) {
    const auto product = this->lobe({0, 0, 1}, sharpness) * this->lobe({0, 0, -1}, sharpness);
    EXPECT_EQ(first(product.sharpness), 0);
    EXPECT_EQ(first(product.axis.z), 1) << "still a unit vector";
    EXPECT_NEAR(first(product.amplitude) / std::exp(-2 * sharpness), 1, 100 * this->kEpsilon);
  }
  for (const double sharpness : {100.0, 1e6}) {  // falls to 0 without a NaN
    const double amplitude = first((this->lobe({0, 0, 1}, sharpness) * this->lobe({0, 0, -1}, sharpness)).amplitude);
    EXPECT_TRUE(amplitude >= 0 && amplitude < 1e-80) << amplitude;
  }
}

TYPED_TEST(Gaussian, OfNoSharpnessIsNeutral) {
  const auto sharp = this->lobe({0.6, 0, 0.8}, 25, 2), flat = this->lobe({0, 1, 0}, 0, 3);
  for (const auto& product : {sharp * flat, flat * sharp}) {
    EXPECT_NEAR(first(product.axis.x), 0.6, 4 * this->kEpsilon);
    EXPECT_NEAR(first(product.axis.z), 0.8, 4 * this->kEpsilon);
    EXPECT_NEAR(first(product.sharpness), 25, 100 * this->kEpsilon);
    EXPECT_EQ(first(product.amplitude), 6);
  }
  EXPECT_EQ(first((flat * flat).amplitude), 9);
  EXPECT_EQ(first((flat * flat).sharpness), 0);
}

TYPED_TEST(Gaussian, TimesAnotherKeepsTinyAndHugeSharpnesses) {  // their squares are no floats
  for (const double sharpness : {1e-35, 1e-20, 1e25}) {
    const auto product = this->lobe({1, 0, 0}, sharpness) * this->lobe({0, 0, 1}, sharpness);
    EXPECT_NEAR(first(product.sharpness) / (sharpness * std::sqrt(2.0)), 1, 8 * this->kEpsilon) << sharpness;
    EXPECT_NEAR(first(product.axis.x), std::sqrt(0.5), 4 * this->kEpsilon) << sharpness;
    EXPECT_TRUE(std::isfinite(first(product.amplitude))) << sharpness;
  }
}

TYPED_TEST(Gaussian, HasItsInnerProduct) {
  for (const double la : {0.0, 0.3, 3.0})
    for (const double lb : {0.0, 1.0, 5.0})
      for (const double angle : {0.0, 0.7, 2.0, std::numbers::pi}) {
        const Vec3<double> b{std::sin(angle), 0, std::cos(angle)};
        const SphericalGaussian<double> there{{0, 0, 1}, la, 2}, other{b, lb, 0.5};
        const double want = over_sphere([&](const Vec3<double>& d) { return there.eval(d) * other.eval(d); });
        EXPECT_NEAR(first(inner_product(this->lobe({0, 0, 1}, la, 2), this->lobe(b, lb, 0.5))) / want, 1,
                    kIsFloat<TypeParam> ? 2e-6 : 1e-13)
            << la << " " << lb << " " << angle;
      }
}

TYPED_TEST(Gaussian, WithAWindowEndsWhereItFallsToOnePercent) {
  for (const double sharpness : {2.4, 10.0, 1e3, 1e6}) {
    const double end = std::log(100) / sharpness;  // as 1 - cos
    EXPECT_EQ(this->windowed(sharpness, 0), 1);
    EXPECT_GT(this->windowed(sharpness, 0.99 * end), 0);
    EXPECT_EQ(this->windowed(sharpness, 1.000001 * end), 0);
    EXPECT_EQ(this->windowed(sharpness, 2), 0);
    EXPECT_NEAR(this->windowed(sharpness, 0.5 * end), 0.05, 1e-6) << "half of a tenth";
    const WindowedGaussian<TypeParam> lobe{this->lobe({0, 0, 1}, sharpness)};
    EXPECT_NEAR(first(lobe.support()), 1 - end, 2 * this->kEpsilon);
    double before = 1;
    for (int i = 1; i <= 1000; ++i) {
      const double now = this->windowed(sharpness, end * i / 1000);
      EXPECT_LE(now, before);
      EXPECT_GE(now, before - 0.006) << "no step: the slope of x is at most 4.9 / 1000";
      before = now;
    }
    EXPECT_LT(this->windowed(sharpness, 0.999 * end), 4e-8) << "and it arrives with slope 0";
  }
}

TYPED_TEST(Gaussian, WithAWindowIsThePlainOneAtNoSharpness) {
  for (const double versine : {0.0, 0.5, 2.0}) EXPECT_EQ(this->windowed(0, versine), 1);
  for (const double sharpness : {1e-30, 1e-9, 1e-3}) EXPECT_NEAR(this->windowed(sharpness, 2), 1, 3 * sharpness);
  const WindowedGaussian<TypeParam> flat{this->lobe({0, 0, 1}, 0)};
  EXPECT_EQ(first(flat.support()), -1);
}

TYPED_TEST(Gaussian, WithAWindowHasItsIntegral) {
  for (const double sharpness : kSharpnesses) {
    const double lambda = double(typename Arithmetic<TypeParam>::Number(sharpness));
    const double end = lambda > 0 ? std::min(2.0, std::log(100) / lambda) : 2;
    const double want = 2 * std::numbers::pi * over_interval(0, end, [&](double v) {
                          const double t = std::max(0.0, 1 - lambda * v / std::log(100));
                          return std::exp(-lambda * v) * t * t * (3 - 2 * t);
                        });
    EXPECT_NEAR(this->windowed_integral(sharpness) / want, 1, kIsFloat<TypeParam> ? 2e-6 : 4e-14) << sharpness;
  }
}

TYPED_TEST(Gaussian, IntegratesWithoutAJumpWhereItsFormChanges) {
  // The joints: the series of mean_decay, the moments at u = 1, and the window that reaches the antipode.
  for (const double joint : {0.5e-5, 0.5, std::log(100) / 2}) {
    const double step = joint * (kIsFloat<TypeParam> ? 1e-5 : 1e-12);
    EXPECT_NEAR(this->integral(joint - step) / this->integral(joint + step), 1, 30 * this->kEpsilon + 3 * step);
    EXPECT_NEAR(this->windowed_integral(joint - step) / this->windowed_integral(joint + step), 1,
                60 * this->kEpsilon + 3 * step);
  }
}

TYPED_TEST(Gaussian, IsFiniteAndNotNegativeEverywhere) {
  Random random(5);
  for (int i = 0; i < 20000; ++i) {
    const double sharpness =
        random.uniform() < 0.5 ? kSharpnesses[random.index(kSharpnesses.size())] : std::exp(random.uniform(-80, 14));
    const double versine = random.uniform() < 0.3 ? 2 * double(random.index(2)) : std::exp(random.uniform(-80, 0.69));
    for (const double x :
         {this->integral(sharpness), this->windowed_integral(sharpness), this->windowed(sharpness, versine),
          first(this->lobe({0, 0, 1}, sharpness).eval(constant<TypeParam>(versine)))})
      ASSERT_TRUE(std::isfinite(x) && x >= 0) << sharpness << " " << versine;
    const auto row = evaluate_row<SphericalGaussianProduct, TypeParam>(
        {random.uniform(0, std::numbers::pi), sharpness, 1, 1e6 * versine, 1});
    for (const double x : row) ASSERT_TRUE(std::isfinite(x) && x >= 0) << sharpness << " " << versine;
  }
}

}  // namespace
}  // namespace likeness::brdf
