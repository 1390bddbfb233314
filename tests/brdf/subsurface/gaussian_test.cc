#include <numbers>

#include "brdf/jet.h"
#include "brdf/subsurface/evaluators.h"
#include "tests/brdf/evaluator_row.h"
#include "tests/brdf/subsurface/profile_errors.h"

// Sums of Gaussians in the place of Burley's profile.
namespace likeness::brdf {
namespace {

template <int kCount>
void expect_energy_and_order() {
  const auto& fit = kGaussianFit<kCount>;
  double sum = fit.delta;
  for (int i = 0; i < kCount; ++i) {
    sum += fit.weight[i];
    EXPECT_GT(fit.weight[i], 0);
    EXPECT_GT(fit.variance[i], i == 0 ? 0 : fit.variance[i - 1]);
  }
  EXPECT_NEAR(sum, 1, 2e-16);                         // the last weight is what is missing to 1
  EXPECT_NEAR(gaussian_cdf<kCount>(1e30), 1, 4e-16);  // the sum in another order
  EXPECT_EQ(gaussian_cdf<kCount>(0.0), fit.delta);
  double integral = fit.delta;
  for (const Node& node : radial_nodes())
    integral += node.weight * 2 * std::numbers::pi * gaussian_profile<kCount>(node.x / 7, 7.0, 1.0) * node.x / 49;
  EXPECT_NEAR(integral, 1, 1e-12);  // the quadrature
}
TEST(Gaussians, HaveExactlyTheEnergyOne) {
  expect_energy_and_order<1>();
  expect_energy_and_order<2>();
  expect_energy_and_order<4>();
}

// Half the sum of squares that the fit makes least, and its gradient.
template <int kCount>
double cost(const double* parameters, double* gradient) {
  constexpr int kParameters = kFitParameters<kCount>;
  using S = ceres::Jet<double, kParameters>;
  std::vector<S> in, residuals(radial_nodes().size());
  for (int i = 0; i < kParameters; ++i) in.emplace_back(parameters[i], i);
  CdfResiduals<kCount>()(in.data(), residuals.data());
  double sum = 0;
  for (int i = 0; i < kParameters; ++i) gradient[i] = 0;
  for (const S& r : residuals) {
    sum += r.a * r.a / 2;
    for (int i = 0; i < kParameters; ++i) gradient[i] += r.a * r.v[i];
  }
  return sum;
}
template <int kCount>
void expect_least() {
  constexpr int kParameters = kFitParameters<kCount>;
  double parameters[kParameters], gradient[kParameters], unused[kParameters];
  fit_parameters<kCount>(parameters);
  const double least = cost<kCount>(parameters, gradient);
  for (int i = 0; i < kParameters; ++i) {
    EXPECT_LE(std::abs(gradient[i]), 1e-6 * least) << kCount << ", " << i;  // 11 digits of the constants: 1e-7 measured
    for (const double step : {-1e-3, 1e-3, -0.3, 0.3}) {
      const double kept = parameters[i];
      parameters[i] += step;
      EXPECT_GT(cost<kCount>(parameters, unused), least) << kCount << ", " << i << " by " << step;
      parameters[i] = kept;
    }
  }
}
TEST(Gaussians, NoStepFromTheConstantsLowersTheErrorTheyWereFittedTo) {
  expect_least<1>();
  expect_least<2>();
  expect_least<4>();
}

// The table on docs/models/gaussian_profile.md, to its last digit.
TEST(Gaussians, ErrorsAreThoseOfThePage) {
  const auto expect = [](const ProfileError& e, double cdf, double worst, double density, double value, double most) {
    EXPECT_NEAR(100 * e.cdf_rms, cdf, 0.051);
    EXPECT_NEAR(100 * e.cdf_worst, worst, 0.051);
    EXPECT_NEAR(100 * e.density_rms, density, 0.051);
    EXPECT_NEAR(100 * e.value_rms, value, 0.051);
    EXPECT_NEAR(100 * e.value_worst, most, 0.51);
  };
  expect(error_of_gaussians<1>(), 20.2, 27.4, 74.2, 75.1, 100);
  expect(error_of_gaussians<2>(), 8.8, 8.4, 49.1, 45.7, 98);
  expect(error_of_gaussians<4>(), 1.3, 2.2, 25.4, 19.1, 46);
}

template <class S>
class Gaussians : public ::testing::Test {};
TYPED_TEST_SUITE(Gaussians, Kinds, KindNames);

template <int kCount>
std::array<double, 2> by_definition(double r, double s, double a) {
  const auto& fit = kGaussianFit<kCount>;
  double value = 0, cdf = fit.delta;
  for (int i = 0; i < kCount; ++i) {
    const double v = fit.variance[i] / (s * s);
    value += fit.weight[i] * std::exp(-r * r / (2 * v)) / (2 * std::numbers::pi * v);
    cdf += fit.weight[i] * -std::expm1(-r * r / (2 * v));
  }
  return {a * value, cdf};
}
template <class S, int kCount>
void expect_definition() {
  Random random(kCount);
  for (int i = 0; i < 1000; ++i) {
    const double s = std::exp(random.uniform(-13.8, 13.8)), x = std::exp(random.uniform(-20, 3.5)),
                 a = random.uniform();
    const std::vector<double> got = evaluate_row<GaussianProfile, S>({double(kCount), x / s, s, a});
    ASSERT_EQ(got, (evaluate_row<GaussianProfileOf<kCount>, S>({x / s, s, a})));
    const auto want = by_definition<kCount>(x / s, s, a);
    // exp of a rounded exponent of at most 87 where it is a float.
    const double zero = (kIsFloat<S> ? 1.2e-38 : 1e-300) * std::max(1.0, s * s);  // of an exponential, before s^2
    ASSERT_LE(relative_difference(got[0], want[0], zero), kIsFloat<S> ? 1.5e-5 : 2e-13);
    ASSERT_LE(relative_difference(got[1], want[1], 1e-300), kIsFloat<S> ? 1e-6 : 1e-14);
  }
}
TYPED_TEST(Gaussians, AreTheirDefinitionForEveryCount) {
  expect_definition<TypeParam, 1>();
  expect_definition<TypeParam, 2>();
  expect_definition<TypeParam, 4>();
}

TYPED_TEST(Gaussians, AreFiniteAtTheOriginAndVanishFarAway) {
  for (const double count : {1.0, 2.0, 4.0})
    for (const double s : {1e-6, 1.0, 1e6}) {
      const auto near = evaluate_row<GaussianProfile, TypeParam>({count, 0, s, 1});
      EXPECT_TRUE(std::isfinite(near[0]) && near[0] > 0) << count << " " << s;
      const auto far = evaluate_row<GaussianProfile, TypeParam>({count, 1e9, 1e6, 1});
      EXPECT_EQ(far[0], 0);
      EXPECT_LE(std::abs(far[1] - 1), 1e-6);  // a sum of floats
    }
}

}  // namespace
}  // namespace likeness::brdf
