#include "realis/mixes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>

#include "realis/solve.h"
#include "realis/weight/samples.h"

namespace likeness::realis {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::size_t kTaken = 2048;  // texels
// Scales: sharpness, and how many lights at most have a lobe of it; and one lobe that is the same everywhere.
constexpr std::array<std::pair<double, std::size_t>, 4> kCandidates{{{128, 96}, {40, 80}, {12, 48}, {4, 24}}};
// The covariance of residuals in two directions, of lobes as near as they come: Matern's of 3/2 of the distance, once
// differentiable, and a constant; over the variance of what a sample may be off by.
constexpr std::array kLengths{0.3, 0.42, 0.6, 0.9, 1.3, 1.9};
constexpr double kConstant = 10, kOverNoise = 100;

// Residuals of the luminance of some texels, lights x texels [1/sr].
Matrix residuals_of(const Subject& s, const Basis& prior, double floor, std::uint64_t seed, std::size_t most) {
  std::vector<std::size_t> order(s.texels()), chosen;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937_64 random(seed);
  const std::size_t lights = s.lights.size();
  for (std::size_t i = 0; i < order.size() && chosen.size() < most; ++i) {
    std::swap(order[i], order[i + random() % (order.size() - i)]);
    const auto weights = s.weight.begin() + static_cast<std::ptrdiff_t>(s.samples_of(order[i]));
    const double trust = std::accumulate(weights, weights + static_cast<std::ptrdiff_t>(lights), 0.0);
    if (lights > 0 && trust >= 0.5 * static_cast<double>(lights)) chosen.push_back(order[i]);
  }
  Matrix out = Matrix::Zero(static_cast<Eigen::Index>(lights), static_cast<Eigen::Index>(chosen.size()));
  Solver solver(prior);
  solver.aim(s.to_lights);
  const std::vector<double> rows = values(prior, s.to_lights);
  std::vector<double> weights(lights), e(lights), coefficients(prior.size());
  for (Eigen::Index t = 0; t < out.cols(); ++t) {
    const std::size_t first = s.samples_of(chosen[static_cast<std::size_t>(t)]);
    bool is_trusted = true;
    for (std::size_t i = 0; i < lights; ++i) {
      weights[i] = static_cast<double>(s.weight[first + i]), e[i] = 0;
      is_trusted &= weights[i] >= 1;
      if (!(weights[i] > 0)) continue;
      const double received = std::max(static_cast<double>(s.cosine[first + i]), floor) * s.irradiance_of(i);
      e[i] = (weight::luminance(s.photo[first + i]) - weight::luminance(s.render[first + i])) / received;
    }
    // What is not trusted is as the prior makes it of the texel's other lights.
    if (!is_trusted) {
      solver.solve(weights, e, coefficients);
      for (std::size_t i = 0; i < lights; ++i) {
        const double found =
            std::inner_product(coefficients.begin(), coefficients.end(),
                               rows.begin() + static_cast<std::ptrdiff_t>(i * coefficients.size()), 0.0);
        e[i] = weights[i] * e[i] + (1 - weights[i]) * found;
      }
    }
    for (std::size_t i = 0; i < lights; ++i) out(static_cast<Eigen::Index>(i), t) = e[i];
  }
  return out;
}

// Lobes times spread: lobes x lights.
Matrix scaled_of(const Basis& basis, std::span<const glm::dvec3> to_lights) {
  const std::vector<double> rows = values(basis.lobes, to_lights);
  Matrix out = Eigen::Map<const Matrix>(rows.data(), static_cast<Eigen::Index>(basis.lobes.size()),
                                        static_cast<Eigen::Index>(to_lights.size()));
  for (Eigen::Index k = 0; k < out.rows(); ++k) out.row(k) *= basis.spread[static_cast<std::size_t>(k)];
  return out;
}

// (K + 1)^-1 of the lights, K = scaled^T scaled.
Matrix inverse_of(const Matrix& scaled) {
  Matrix system = Matrix::Identity(scaled.cols(), scaled.cols());
  system.selfadjointView<Eigen::Lower>().rankUpdate(scaled.transpose());
  return system.selfadjointView<Eigen::Lower>().llt().solve(Matrix::Identity(scaled.cols(), scaled.cols()));
}

Matrix covariance_of(std::span<const glm::dvec3> to_lights, double length) {
  const auto count = static_cast<Eigen::Index>(to_lights.size());
  Matrix out(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index k = 0; k < count; ++k) {
      const double q = std::numbers::sqrt3 *
                       glm::length(to_lights[static_cast<std::size_t>(i)] - to_lights[static_cast<std::size_t>(k)]) /
                       length;
      out(i, k) = kOverNoise * ((1 + q) * std::exp(-q) + kConstant);
    }
  return out;
}

}  // namespace

// Variances of the scales by least squares over all pairs of lights, none below 0: coordinate descent.
Basis prior_of(std::span<const glm::dvec3> to_lights, double length) {
  Basis out;
  if (to_lights.empty()) return out;
  std::vector<std::size_t> ends;
  for (const auto& [sharpness, most] : kCandidates) {
    for (const glm::dvec3& axis : spread_out(to_lights, most)) out.lobes.push_back({axis, sharpness});
    ends.push_back(out.lobes.size());
  }
  out.lobes.push_back({glm::dvec3(0, 0, 1), 0});
  ends.push_back(out.lobes.size());
  out.spread.assign(out.lobes.size(), 1.0);
  const Matrix all = scaled_of(out, to_lights);
  std::vector<Matrix> made;
  for (std::size_t k = 0, first = 0; k < ends.size(); first = ends[k++]) {
    const auto rows = all.middleRows(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(ends[k] - first));
    made.emplace_back(rows.transpose() * rows);
  }
  Matrix left = covariance_of(to_lights, length);
  std::vector<double> variances(made.size(), 0.0);
  constexpr int kRounds = 500;
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t k = made.size(); k-- > 0;) {
      const double step =
          std::max(left.cwiseProduct(made[k]).sum() / std::max(made[k].squaredNorm(), 1e-300), -variances[k]);
      variances[k] += step, left -= step * made[k];
    }
  for (std::size_t k = 0, first = 0; k < ends.size(); first = ends[k++])
    std::fill(out.spread.begin() + static_cast<std::ptrdiff_t>(first),
              out.spread.begin() + static_cast<std::ptrdiff_t>(ends[k]), std::sqrt(variances[k]));
  return out;
}

// Of (K + 1) c = e the residual of a light that is left out is c_i / ((K + 1)^-1)_ii (Rasmussen and Williams 2006, eq. 5.12).
double prior_length(const Subject& subject, double floor, std::uint64_t seed) {
  if (subject.lights.size() < kLightsToChoose) return kPriorLength;
  const Matrix e = residuals_of(subject, prior_of(subject.to_lights), floor, seed, kTaken);
  double least = HUGE_VAL, best = kPriorLength;
  for (const double length : kLengths) {
    const auto lights = e.rows();
    const Matrix inverse = (covariance_of(subject.to_lights, length) + Matrix::Identity(lights, lights))
                               .llt()
                               .solve(Matrix::Identity(lights, lights));
    const double sum = (inverse.diagonal().cwiseInverse().asDiagonal() * (inverse * e)).squaredNorm();
    if (sum < least) least = sum, best = length;
  }
  return best;
}

struct Mixes::Work {
  Basis prior;
  Matrix mix;        // lobes x mixes
  Vector strength;   // variance of each mix's coefficients
  Vector explained;  // of the samples' squares
  double all = 0;    // of the samples' squares
  double left = 0;   // that the prior takes for noise
  Eigen::Index lights = 0;
};

Mixes::Mixes(const Subject& subject, const Basis& prior, double floor, std::uint64_t seed)
    : work_(std::make_unique<Work>()) {
  Work& w = *work_;
  w.prior = prior;
  const Matrix e = residuals_of(subject, prior, floor, seed, kTaken);
  w.lights = e.rows();
  if (e.size() == 0 || prior.lobes.empty()) return;
  const auto texels = static_cast<double>(e.cols());
  const Matrix scaled = scaled_of(prior, subject.to_lights), inverse = inverse_of(scaled);
  const Matrix smooth = scaled.transpose() * (scaled * inverse);  // K (K + 1)^-1
  const Matrix square = e * e.transpose();
  const Matrix made = smooth * square * smooth.transpose();  // m m^T of m = K (K + 1)^-1 e
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(made);
  constexpr double kNone = 1e-10;
  const double largest = eigen.eigenvalues().maxCoeff();
  Eigen::Index count = 0;
  while (count < std::min<Eigen::Index>(w.lights, static_cast<Eigen::Index>(baked::kMostLobes)) &&
         eigen.eigenvalues()[w.lights - 1 - count] > kNone * largest && largest > 0)
    ++count;
  const Matrix axes = eigen.eigenvectors().rightCols(count).rowwise().reverse();
  w.strength = eigen.eigenvalues().tail(count).reverse() / texels;
  // A component as a function: S^2 B^T (K + 1)^-1 e m^T u / lambda.
  w.mix = scaled * (inverse * (square * (smooth.transpose() * axes)));
  for (Eigen::Index k = 0; k < w.mix.rows(); ++k) w.mix.row(k) *= prior.spread[static_cast<std::size_t>(k)];
  for (Eigen::Index k = 0; k < count; ++k) w.mix.col(k) /= w.strength[k] * texels;
  w.all = square.trace();
  w.explained.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) w.explained[k] = axes.col(k).dot(square * axes.col(k));
  const Matrix rest = Matrix::Identity(w.lights, w.lights) - smooth;
  w.left = (rest * square * rest.transpose()).trace();
  w.all /= texels, w.explained /= texels, w.left /= texels;
}
Mixes::~Mixes() = default;
Mixes::Mixes(Mixes&&) noexcept = default;

std::size_t Mixes::size() const { return static_cast<std::size_t>(work_->strength.size()); }

Basis Mixes::first(std::size_t count) const {
  const Work& w = *work_;
  const auto taken = static_cast<Eigen::Index>(std::min(count, size()));
  Basis out;
  if (taken == 0) return out;
  out.lobes = w.prior.lobes;
  const double noise = w.left / static_cast<double>(w.lights);  // of a light, as the prior has it
  constexpr double kFree = 1e6;
  for (Eigen::Index k = 0; k < taken; ++k) {
    out.spread.push_back(noise > 0 ? std::min(std::sqrt(w.strength[k] / noise), kFree) : kFree);
    for (Eigen::Index j = 0; j < w.mix.rows(); ++j) out.mix.push_back(w.mix(j, k));
  }
  return out;
}

}  // namespace likeness::realis
