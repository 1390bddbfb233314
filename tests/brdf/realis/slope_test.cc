#include "brdf/realis/evaluators.h"
#include "tests/brdf/realis/by_definition.h"
#include "tests/brdf/row_slope.h"

// Derivatives of what a bake is refined with.
namespace likeness::brdf {
namespace {

TEST(RealisSlope, OfTheResidualByEverything) {
  const std::vector<double> in{0.48, 0.6, 0.64, 0.3,  -0.2, 0.9, 0.4,   0.15, 0.1,  0.7, 0.0, 0.6, 0.8,
                               7,    0.1, 0.8,  -0.6, 0,    2,   -0.05, 0.36, 0.48, 0.8, 30,  0.02};
  for (std::size_t k = 0; k < in.size(); ++k) expect_slope<RealisResidual>(in, k, 1e-7);
  std::vector<double> behind = in;  // below the floor, where the cosine does not count
  behind[6] = -0.4;
  for (std::size_t k = 0; k < in.size(); ++k) expect_slope<RealisResidual>(behind, k, 1e-7);
  std::vector<double> flat = in;
  flat[13] = 0;
  expect_slope<RealisResidual>(flat, 13, 1e-4, 1e-5, 1);
}

TEST(RealisSlope, OfOneLobe) {
  for (const double sharpness : {1e-3, 2.0, 5.0, 300.0})
    for (const double angle : {0.01, 0.1, 0.9})
      for (std::size_t k = 0; k < 4; ++k) {
        expect_slope<RealisLobeExact, RealisByAngle>({angle, sharpness, 200, 0.3}, k, 1e-6);
        expect_slope<RealisLobe5, RealisByAngle>({angle, sharpness, 200, 0.3}, k, 1e-6);
        expect_slope<RealisLobe7, RealisByAngle>({angle, sharpness, 200, 0.3}, k, 1e-6);
      }
}

TEST(RealisSlope, OfTheFade) {
  const std::vector<double> in{0.4, 0.2, 0.3, 0.5, 0.28, 0.19, 0.29, 0.6, 0.3};
  for (std::size_t k = 0; k < in.size(); ++k) expect_slope<RealisFaded>(in, k, 1e-6);
}

TEST(RealisSlope, OfTheDemodulation) {
  for (const double cos_i : {0.5, -0.3})
    for (std::size_t k = 0; k < 4; ++k) expect_slope<RealisDemodulated>({0.3, 2, cos_i, 0.1}, k, 1e-8);
}

// A texel's own, towards a light that moves.
TEST(RealisSlope, OfATexelByTheDirection) {
  using Dual = ceres::Jet<double, 3>;
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const Drawn drawn = drawn_texel(random);
    const Vec3<double> v = random.direction(-1);
    const Dual e = residual(drawn.lobes, drawn.texel, Vec3<Dual>(Dual(v.x, 0), Dual(v.y, 1), Dual(v.z, 2)));
    EXPECT_NEAR(e.a, residual(drawn.lobes, drawn.texel, v), 1e-14);
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 3; ++k) {
      Vec3<double> ahead = v, back = v;
      (k == 0 ? ahead.x : k == 1 ? ahead.y : ahead.z) += kStep;
      (k == 0 ? back.x : k == 1 ? back.y : back.z) -= kStep;
      const double want =
          (residual(drawn.lobes, drawn.texel, ahead) - residual(drawn.lobes, drawn.texel, back)) / (2 * kStep);
      // The second derivative jumps where a window ends: 40^2 of sharpness times the step.
      EXPECT_NEAR(e.v[k], want, 2e-3 * magnitude(drawn.written)) << i;
    }
  }
}

TEST(RealisSlope, IsFiniteWhereItIsHard) {
  using Dual = ceres::Jet<double, 3>;
  Random random(4);
  for (int i = 0; i < 3000; ++i) {
    const Drawn drawn = drawn_texel(random, 1e6);
    const Vec3<double> axis = drawn.written[0].axis;
    const double sign = i % 3 - 1.0;  // opposite, nowhere, along the axis
    const Dual e = residual(drawn.lobes, drawn.texel,
                            Vec3<Dual>(Dual(sign * axis.x, 0), Dual(sign * axis.y, 1), Dual(sign * axis.z, 2)));
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(std::isfinite(e.v[k])) << i;
  }
}

}  // namespace
}  // namespace likeness::brdf
