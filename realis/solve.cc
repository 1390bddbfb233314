#include "realis/solve.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace likeness::realis {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Columns = Eigen::Map<const Matrix>;

// Both ways solve the same equations. With more lobes than lights that see the texel the smaller system is that of the
// lights, with the covariance B S B^T + 1/W; else that of the lobes, B^T W B + 1/S.
struct Solver::Work {
  Basis basis;
  Matrix values;      // lights x lobes, times spread: coefficients are then in units of it
  Matrix covariance;  // lights x lights: values values^T
  std::vector<Eigen::Index> seen;
  std::vector<std::size_t> chosen, largest;
  Matrix system, rows, right, found;
  Eigen::LLT<Matrix> factor;

  Eigen::Index lobes() const { return static_cast<Eigen::Index>(basis.size()); }
  void take(std::span<const double> weights) {
    seen.clear();
    for (std::size_t i = 0; i < weights.size(); ++i)
      if (weights[i] > 0) seen.push_back(static_cast<Eigen::Index>(i));
  }
  Eigen::Index count() const { return static_cast<Eigen::Index>(seen.size()); }
  // The covariance of the samples of the lights that see the texel.
  void factor_of_lights(std::span<const double> weights) {
    system.resize(count(), count());
    for (Eigen::Index j = 0; j < count(); ++j) {
      for (Eigen::Index i = j; i < count(); ++i)
        system(i, j) = covariance(seen[static_cast<std::size_t>(i)], seen[static_cast<std::size_t>(j)]);
      system(j, j) += 1 / weights[static_cast<std::size_t>(seen[j])];
    }
    factor.compute(system);  // reads the lower half
  }
};

Solver::Solver(Basis basis) : work_(std::make_unique<Work>()) { work_->basis = std::move(basis); }
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;

const Basis& Solver::basis() const { return work_->basis; }

void Solver::aim(std::span<const glm::dvec3> to_lights) {
  Work& w = *work_;
  const std::vector<double> rows = values(w.basis, to_lights);
  const auto lights = static_cast<Eigen::Index>(to_lights.size());
  w.values = Columns(rows.data(), w.lobes(), lights).transpose();
  for (Eigen::Index k = 0; k < w.lobes(); ++k) w.values.col(k) *= w.basis.spread[static_cast<std::size_t>(k)];
  w.covariance = w.values * w.values.transpose();
}

void Solver::solve(std::span<const double> weights, std::span<const double> residuals, std::span<double> coefficients) {
  Work& w = *work_;
  w.chosen.resize(w.basis.size());
  std::iota(w.chosen.begin(), w.chosen.end(), std::size_t{0});
  solve_with(w.chosen, weights, residuals, coefficients);
}

void Solver::solve_with(std::span<const std::size_t> chosen, std::span<const double> weights,
                        std::span<const double> residuals, std::span<double> coefficients) {
  Work& w = *work_;
  std::fill(coefficients.begin(), coefficients.end(), 0.0);
  w.take(weights);
  if (w.seen.empty() || chosen.empty()) return;
  const auto all_lights = static_cast<Eigen::Index>(weights.size()), lobes = static_cast<Eigen::Index>(chosen.size());
  const Eigen::Index lights = w.count(), channels = static_cast<Eigen::Index>(residuals.size()) / all_lights;
  const Columns given(residuals.data(), all_lights, channels);
  const bool is_whole = lobes == w.lobes();
  if (is_whole && lights <= lobes) {
    w.factor_of_lights(weights);
    w.right.resize(lights, channels);
    for (Eigen::Index i = 0; i < lights; ++i) w.right.row(i) = given.row(w.seen[static_cast<std::size_t>(i)]);
    w.factor.solveInPlace(w.right);
    w.found.setZero(lobes, channels);
    for (Eigen::Index i = 0; i < lights; ++i)
      w.found.noalias() += w.values.row(w.seen[static_cast<std::size_t>(i)]).transpose() * w.right.row(i);
  } else {
    w.rows.resize(lights, lobes);  // sqrt(w) B, of the lights that are seen
    w.right.resize(lights, channels);
    for (Eigen::Index i = 0; i < lights; ++i) {
      const Eigen::Index light = w.seen[static_cast<std::size_t>(i)];
      const double root = std::sqrt(weights[static_cast<std::size_t>(light)]);
      for (Eigen::Index k = 0; k < lobes; ++k)
        w.rows(i, k) = root * w.values(light, static_cast<Eigen::Index>(chosen[static_cast<std::size_t>(k)]));
      w.right.row(i) = root * given.row(light);
    }
    w.system = Matrix::Identity(lobes, lobes);
    w.system.selfadjointView<Eigen::Lower>().rankUpdate(w.rows.transpose());
    w.factor.compute(w.system);
    w.found.noalias() = w.rows.transpose() * w.right;
    w.factor.solveInPlace(w.found);
  }
  Eigen::Map<Matrix> out(coefficients.data(), w.lobes(), channels);
  for (Eigen::Index k = 0; k < lobes; ++k) {
    const std::size_t lobe = chosen[static_cast<std::size_t>(k)];
    out.row(static_cast<Eigen::Index>(lobe)) = w.basis.spread[lobe] * w.found.row(k);
  }
}

void Solver::solve_kept(std::size_t kept, std::span<const double> weights, std::span<const double> residuals,
                        std::span<double> coefficients) {
  solve(weights, residuals, coefficients);
  const std::size_t lobes = work_->basis.size();
  if (kept >= lobes) return;
  std::vector<std::size_t>& chosen = work_->largest;
  const auto size = [&](std::size_t k) {
    double sum = 0;
    for (std::size_t c = k; c < coefficients.size(); c += lobes) sum += std::abs(coefficients[c]);
    return sum;
  };
  chosen.resize(lobes);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  std::partial_sort(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(kept), chosen.end(),
                    [&](std::size_t a, std::size_t b) {
                      const double x = size(a), y = size(b);
                      return x != y ? x > y : a < b;
                    });
  chosen.resize(kept);
  solve_with(chosen, weights, residuals, coefficients);
}

// Source  Rasmussen and Williams 2006, Gaussian Processes for Machine Learning, eq. 5.12: y_i - mu_i = [K^-1 y]_i /
//         [K^-1]_ii.
void Solver::held_out(std::span<const double> weights, std::span<const double> residuals, std::span<double> left) {
  Work& w = *work_;
  const auto lights = static_cast<Eigen::Index>(weights.size());
  const Eigen::Index channels = lights > 0 ? static_cast<Eigen::Index>(residuals.size()) / lights : 0;
  w.take(weights);
  w.factor_of_lights(weights);
  const Matrix inverse = w.factor.solve(Matrix::Identity(w.count(), w.count()));
  const Columns given(residuals.data(), lights, channels);
  Eigen::Map<Matrix> out(left.data(), lights, channels);
  w.right.resize(w.count(), channels);
  for (Eigen::Index i = 0; i < w.count(); ++i) w.right.row(i) = given.row(w.seen[static_cast<std::size_t>(i)]);
  const Matrix solved = inverse * w.right;
  out.setZero();
  for (Eigen::Index i = 0; i < w.count(); ++i)
    out.row(w.seen[static_cast<std::size_t>(i)]) = solved.row(i) / inverse(i, i);
}

}  // namespace likeness::realis
