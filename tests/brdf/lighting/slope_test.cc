#include "brdf/lighting/evaluators.h"
#include "tests/brdf/row_slope.h"

// Derivatives of what lights and displays are fitted with.
namespace likeness::brdf {
namespace {

TEST(LightingSlope, OfSphericalGaussians) {
  for (const double sharpness : {1e-3, 0.4, 2.0, 5.0, 300.0})
    for (const double angle : {0.01, 0.3, 2.0})
      for (std::size_t k = 0; k < 3; ++k) {
        expect_slope<PlainSphericalGaussian, ByAngle>({angle, sharpness, 2}, k, 1e-7, 1e-5);
        expect_slope<WindowedSphericalGaussian, ByAngle>({angle, sharpness, 2}, k, 1e-6, 1e-5);
      }
  for (std::size_t k = 0; k < 5; ++k) {
    expect_slope<SphericalGaussianProduct>({0.7, 10, 2, 25, 0.5}, k, 1e-7);
    expect_slope<SphericalGaussianProduct>({2.5, 0.1, 2, 3, 0.5}, k, 1e-7);
  }
}

TEST(LightingSlope, OfSharpnessWhereItBegins) {  // sharpness 0 is the end of the range
  for (const double angle : {0.5, 2.0}) {
    expect_slope<PlainSphericalGaussian, ByAngle>({angle, 0, 2}, 1, 1e-6, 1e-5, 1);
    expect_slope<WindowedSphericalGaussian, ByAngle>({angle, 0, 2}, 1, 1e-4, 1e-5, 1);
  }
  expect_slope<PlainSphericalGaussian, ByAngle>({1e-3, 1e6, 2}, 1, 1e-6, 1e-6);
  expect_slope<WindowedSphericalGaussian, ByAngle>({1e-3, 1e6, 2}, 1, 1e-6, 1e-6);
}

TEST(LightingSlope, OfSphericalHarmonics) {
  std::vector<double> in{1, 0.1, 0.2, 0.3, -0.4, 0.5, 0.6, -0.7, 0.8, 0.48, 0.6, 0.64};
  for (std::size_t k = 0; k < 12; ++k) expect_slope<ShValue>(in, k, 1e-9);
  for (std::size_t k = 0; k < 12; ++k) expect_slope<ShRotated>(in, k, 1e-9);
  for (std::size_t k = 9; k < 12; ++k) {
    in[9] = in[10] = in[11] = 0;
    expect_slope<ShRotated>(in, k, 1e-7);
  }
  for (std::size_t k = 0; k < 9; ++k)
    expect_slope<ShCompressed>({1, 0.1, 0.2, 0.3, -0.4, 0.5, 0.6, -0.7, 0.8}, k, 1e-9);
}

// x, or y, in each part of the curve; then P, a, m, l, c, b.
TEST(LightingSlope, OfTheTonemapper) {
  for (const double x : {0.003, 0.05, 0.2, 0.4, 0.8, 3.0})
    for (std::size_t k = 0; k < 7; ++k) expect_slope<Tonemap>({x, 1.1, 1.05, 0.22, 0.4, 1.33, 0.01}, k, 1e-8, 1e-7);
}
TEST(LightingSlope, OfItsInverse) {
  for (const double y : {0.012, 0.05, 0.2, 0.4, 0.8, 1.05})
    for (std::size_t k = 0; k < 7; ++k)
      expect_slope<TonemapInverse>({y, 1.1, 1.05, 0.22, 0.4, 1.33, 0.01}, k, 1e-7, 1e-7);
}
TEST(LightingSlope, OfTheTonemapperIsFiniteAtItsEnds) {
  using Dual = ceres::Jet<double, 7>;
  for (const std::vector<double>& k :
       {std::vector<double>{1, 1, 0.22, 1, 1.33, 0}, {1, 1, 0, 0.4, 1.33, 0}, {1, 1, 0.22, 0, 1, 0}})
    for (const double x : {0.0, 1e-30, 0.22, 0.532, 1.0, 1e9, 1e300}) {
      std::vector<Dual> in{Dual(x, 0)};
      for (int i = 0; i < 6; ++i) in.emplace_back(k[std::size_t(i)], i + 1);
      const Dual y = outputs_of<Tonemap, Identity<Tonemap>>(in)[0];
      const Dual back = outputs_of<TonemapInverse, TonemapInverse::Form>(in)[0];
      for (int i = 0; i < 7; ++i) EXPECT_TRUE(std::isfinite(y.v[i]) && std::isfinite(back.v[i])) << x << " by " << i;
    }
}

TEST(LightingSlope, OfZones) {
  for (const double luminance : {1e-4, 0.18, 30.0})
    for (std::size_t k = 0; k < 3; ++k) {
      using Dual = ceres::Jet<double, 1>;
      std::vector<Dual> in{Dual(luminance), Dual(0.18), Dual(5.0)};
      in[k].v[0] = 1;
      const double got = outputs_of<ExposureZone, Identity<ExposureZone>>(in)[0].v[0];
      const double want = k == 0 ? 1 / (luminance * std::log(2)) : k == 1 ? -1 / (0.18 * std::log(2)) : 1;
      EXPECT_NEAR(got / want, 1, 1e-12);
    }
}

}  // namespace
}  // namespace likeness::brdf
