#include "realis/solve.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "realis/choose.h"
#include "tests/realis/domes.h"

namespace likeness::realis {
namespace {

Basis some_basis(std::size_t lobes, double sharpness) {
  Basis basis;
  for (const glm::dvec3& axis : test::dome(lobes)) basis.lobes.push_back({axis, sharpness});
  for (std::size_t k = 0; k < lobes; ++k) basis.spread.push_back(0.5 + 0.1 * static_cast<double>(k % 7));
  return basis;
}
std::vector<double> randoms(std::size_t count, unsigned seed, double low = -1, double high = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(low, high);
  std::vector<double> out(count);
  for (double& x : out) x = value(random);
  return out;
}

// The minimum by its normal equations, written down once more.
Eigen::VectorXd by_normal_equations(const Basis& basis, const std::vector<glm::dvec3>& lights,
                                    const std::vector<double>& weights, const double* e) {
  const std::vector<double> rows = values(basis.lobes, lights);
  const auto n = static_cast<Eigen::Index>(lights.size()), k = static_cast<Eigen::Index>(basis.lobes.size());
  const Eigen::MatrixXd b = Eigen::Map<const Eigen::MatrixXd>(rows.data(), k, n).transpose();
  const Eigen::VectorXd w = Eigen::Map<const Eigen::VectorXd>(weights.data(), n);
  const Eigen::VectorXd s = Eigen::Map<const Eigen::VectorXd>(basis.spread.data(), k);
  Eigen::MatrixXd a = b.transpose() * w.asDiagonal() * b;
  a.diagonal() += s.cwiseProduct(s).cwiseInverse();
  return a.fullPivLu().solve(b.transpose() * w.asDiagonal() * Eigen::Map<const Eigen::VectorXd>(e, n));
}

class Sizes : public testing::TestWithParam<std::pair<std::size_t, std::size_t>> {};

// Both ways to solve: more lobes than lights, and fewer. Condition numbers stay below 1e4 here, so that 1e-10 of the
// largest coefficient is what two solvers in double may differ by.
TEST_P(Sizes, MinimisesWhatItSays) {
  const auto [lobes, lights] = GetParam();
  const Basis basis = some_basis(lobes, 8);
  const std::vector<glm::dvec3> to_lights = test::dome(lights);
  Solver solver(basis);
  solver.aim(to_lights);
  std::vector<double> weights = randoms(lights, 1, 0, 2);
  weights[lights / 2] = 0;
  const std::vector<double> residuals = randoms(3 * lights, 2);
  std::vector<double> found(3 * lobes);
  solver.solve(weights, residuals, found);
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::VectorXd truth = by_normal_equations(basis, to_lights, weights, residuals.data() + c * lights);
    for (std::size_t k = 0; k < lobes; ++k)
      EXPECT_NEAR(found[c * lobes + k], truth[static_cast<Eigen::Index>(k)], 1e-10 * truth.cwiseAbs().maxCoeff());
  }
}
INSTANTIATE_TEST_SUITE_P(Solve, Sizes,
                         testing::Values(std::pair{40, 12}, std::pair{12, 40}, std::pair{16, 16}, std::pair{1, 1},
                                         std::pair{5, 1}, std::pair{1, 5}),
                         [](const auto& row) {
                           return "Lobes" + std::to_string(row.param.first) + "Lights" +
                                  std::to_string(row.param.second);
                         });

TEST(Solve, OfSomeLobesIsTheBasisOfThoseAlone) {
  const Basis basis = some_basis(10, 6);
  const std::vector<std::size_t> chosen{7, 2, 4};
  Basis part;
  for (const std::size_t k : chosen) part.lobes.push_back(basis.lobes[k]), part.spread.push_back(basis.spread[k]);
  const std::vector<glm::dvec3> lights = test::dome(15);
  const std::vector<double> weights = randoms(15, 3, 0.1, 1), residuals = randoms(15, 4);
  Solver whole(basis), alone(part);
  whole.aim(lights), alone.aim(lights);
  std::vector<double> found(10), truth(3);
  whole.solve_with(chosen, weights, residuals, found);
  alone.solve(weights, residuals, truth);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[chosen[i]], truth[i], 1e-12);
  for (const std::size_t k : {0u, 1u, 3u, 5u, 6u, 8u, 9u}) EXPECT_EQ(found[k], 0);
}

// In closed form and by leaving each light out in turn.
TEST(Solve, HeldOutIsWhatRefittingWithoutTheLightLeaves) {
  const Basis basis = some_basis(14, 10);
  const std::vector<glm::dvec3> lights = test::dome(22);
  const std::vector<double> residuals = randoms(2 * 22, 5);
  std::vector<double> weights = randoms(22, 6, 0.2, 3);
  weights[4] = 0;
  Solver solver(basis);
  solver.aim(lights);
  std::vector<double> left(2 * 22), coefficients(2 * 14);
  solver.held_out(weights, residuals, left);
  const std::vector<double> rows = values(basis.lobes, lights);
  for (std::size_t i = 0; i < 22; ++i) {
    if (i == 4) continue;
    std::vector<double> without = weights;
    without[i] = 0;
    solver.solve(without, residuals, coefficients);
    for (std::size_t c = 0; c < 2; ++c) {
      double predicted = 0;
      for (std::size_t k = 0; k < 14; ++k) predicted += coefficients[c * 14 + k] * rows[i * 14 + k];
      EXPECT_NEAR(left[c * 22 + i], residuals[c * 22 + i] - predicted, 1e-10);
    }
  }
  EXPECT_EQ(left[4], 0);
}

TEST(Solve, ReadsNothingOfWhatHasNoWeight) {
  const Basis basis = some_basis(6, 5);
  const std::vector<glm::dvec3> lights = test::dome(9);
  std::vector<double> weights(9, 1.0), residuals = randoms(9, 8), clean(6), spoiled(6);
  weights[3] = 0;
  Solver solver(basis);
  solver.aim(lights);
  solver.solve(weights, residuals, clean);
  residuals[3] = std::numeric_limits<double>::quiet_NaN();
  solver.solve(weights, residuals, spoiled);
  EXPECT_EQ(spoiled, clean);
}

TEST(Solve, KnowsNothingOfATexelThatNoLightSees) {
  Solver solver(some_basis(6, 5));
  solver.aim(test::dome(4));
  std::vector<double> found(6, 9.0);
  solver.solve(std::vector<double>(4, 0.0), std::vector<double>(4, 1.0), found);
  EXPECT_EQ(found, std::vector<double>(6, 0.0));
}

// Lights at one place, in one plane, or fewer than lobes: what the regulariser promises, whatever the residuals.
TEST(Solve, IsBoundedByTheRegulariser) {
  Basis basis = some_basis(24, 3);
  for (double& spread : basis.spread) spread = 2;
  std::vector<glm::dvec3> plane;
  for (int i = 0; i < 9; ++i) plane.emplace_back(std::cos(0.3 * i), std::sin(0.3 * i), 0.0);
  for (const std::vector<glm::dvec3>& lights : {std::vector(12, glm::dvec3(0, 0, 1)), plane, test::dome(2)}) {
    Solver solver(basis);
    solver.aim(lights);
    std::vector<double> residuals = randoms(lights.size(), 9);
    residuals[0] *= 100;  // one light a hundred times brighter
    const std::vector<double> weights(lights.size(), 1.0);
    std::vector<double> found(24);
    solver.solve(weights, residuals, found);
    double sum = 0;
    for (const double e : residuals) sum += e * e;
    for (const double c : found) {
      EXPECT_TRUE(std::isfinite(c));
      EXPECT_LE(c * c, 4 * sum);
    }
  }
}

}  // namespace
}  // namespace likeness::realis
