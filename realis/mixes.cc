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

#include "realis/weight/samples.h"

namespace likeness::realis {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::size_t kTaken = 2048;  // texels
// Scales: sharpness, and how many lights at most have a lobe of it; and one lobe that is the same everywhere.
constexpr std::array<std::pair<double, std::size_t>, 4> kCandidates{{{128, 96}, {40, 80}, {12, 48}, {4, 24}}};
// The covariance of residuals in two directions: Matern's of 3/2 of the distance, once differentiable, and a constant; over
// the variance of what a sample may be off by.
constexpr std::array kLengths{0.3, 0.42, 0.6, 0.9, 1.3, 1.9};
constexpr double kConstant = 10, kOverNoise = 100;

Matrix covariance_of(std::span<const glm::dvec3> a, std::span<const glm::dvec3> b, double length) {
  Matrix out(static_cast<Eigen::Index>(a.size()), static_cast<Eigen::Index>(b.size()));
  for (Eigen::Index k = 0; k < out.cols(); ++k)
    for (Eigen::Index i = 0; i < out.rows(); ++i) {
      const double q =
          std::numbers::sqrt3 * glm::length(a[static_cast<std::size_t>(i)] - b[static_cast<std::size_t>(k)]) / length;
      out(i, k) = kOverNoise * ((1 + q) * std::exp(-q) + kConstant);
    }
  return out;
}

// (K + 1)^-1.
Matrix inverse_of(Matrix covariance) {
  covariance.diagonal().array() += 1;
  return covariance.selfadjointView<Eigen::Lower>().llt().solve(Matrix::Identity(covariance.rows(), covariance.cols()));
}

// Evenly over the sphere (Fibonacci), 0.08 from each other.
std::vector<glm::dvec3> everywhere() {
  constexpr int kDirections = 2000;
  std::vector<glm::dvec3> out;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - 2 * (i + 0.5) / kDirections, around = 2 * std::numbers::pi * i / std::numbers::phi,
                 r = std::sqrt(1 - z * z);
    out.emplace_back(r * std::cos(around), r * std::sin(around), z);
  }
  return out;
}

std::vector<Lobe> lobes_at(std::span<const glm::dvec3> to_lights) {
  std::vector<Lobe> out;
  for (const auto& [sharpness, most] : kCandidates)
    for (const glm::dvec3& axis : spread_out(to_lights, most)) out.push_back({axis, sharpness});
  if (!to_lights.empty()) out.push_back({glm::dvec3(0, 0, 1), 0});
  return out;
}

// The covariance with each light as a function of the direction, as sums of lobes: lobes x lights. Least squares over the
// sphere, closer at the lights and about them, where light is asked for.
Matrix functions_of(std::span<const Lobe> lobes, std::span<const glm::dvec3> to_lights, double length) {
  constexpr double kAtLights = 2, kFar = 0.3, kRidge = 1e-3;  // of deviations; of amplitudes
  constexpr double kNear = 0.97;                              // cosine of 14 degrees
  std::vector<glm::dvec3> directions = everywhere();
  Vector weight(static_cast<Eigen::Index>(directions.size() + to_lights.size()));
  for (std::size_t i = 0; i < directions.size(); ++i)
    weight[static_cast<Eigen::Index>(i)] =
        std::any_of(to_lights.begin(), to_lights.end(),
                    [&](const glm::dvec3& light) { return glm::dot(light, directions[i]) > kNear; })
            ? 1
            : kFar;
  weight.tail(static_cast<Eigen::Index>(to_lights.size())).setConstant(kAtLights);
  directions.insert(directions.end(), to_lights.begin(), to_lights.end());
  const std::vector<double> rows = values(lobes, directions);
  const Matrix at = Eigen::Map<const Matrix>(rows.data(), static_cast<Eigen::Index>(lobes.size()),
                                             static_cast<Eigen::Index>(directions.size())) *
                    weight.asDiagonal();
  Matrix system = kRidge * Matrix::Identity(at.rows(), at.rows());
  system.selfadjointView<Eigen::Lower>().rankUpdate(at);
  const Matrix wanted = weight.asDiagonal() * covariance_of(directions, to_lights, length);
  return system.selfadjointView<Eigen::Lower>().llt().solve(at * wanted);
}

// Residuals of the luminance of some texels, lights x texels [1/sr].
Matrix residuals_of(const Subject& s, const Matrix& covariance, double floor, std::uint64_t seed, std::size_t most) {
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
  Vector weights(static_cast<Eigen::Index>(lights)), e(static_cast<Eigen::Index>(lights));
  for (Eigen::Index t = 0; t < out.cols(); ++t) {
    const std::size_t first = s.samples_of(chosen[static_cast<std::size_t>(t)]);
    bool is_trusted = true;
    for (std::size_t i = 0; i < lights; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      weights[at] = static_cast<double>(s.weight[first + i]), e[at] = 0;
      is_trusted &= weights[at] >= 1;
      if (!(weights[at] > 0)) continue;
      const double received = std::max(static_cast<double>(s.cosine[first + i]), floor) * s.irradiance_of(i);
      e[at] = (weight::luminance(s.photo[first + i]) - weight::luminance(s.render[first + i])) / received;
    }
    // What is not trusted is as the prior makes it of the texel's other lights: noise of variance 1 / weight.
    if (!is_trusted) {
      const Vector root = weights.cwiseMax(0).cwiseSqrt();
      Matrix system = root.asDiagonal() * covariance * root.asDiagonal();
      system.diagonal().array() += 1;
      const Vector found = covariance * (root.asDiagonal() * system.llt().solve(root.cwiseProduct(e)));
      const Vector trust = weights.cwiseMin(1);
      e = trust.cwiseProduct(e) + (1 - trust.array()).matrix().cwiseProduct(found);
    }
    out.col(t) = e;
  }
  return out;
}

}  // namespace

// Of (K + 1) c = e the residual of a light that is left out is c_i / ((K + 1)^-1)_ii (Rasmussen and Williams 2006, eq. 5.12).
double prior_length(const Subject& subject, double floor, std::uint64_t seed) {
  if (subject.lights.size() < kLightsToChoose) return kPriorLength;
  const Matrix e =
      residuals_of(subject, covariance_of(subject.to_lights, subject.to_lights, kPriorLength), floor, seed, kTaken);
  double least = HUGE_VAL, best = kPriorLength;
  for (const double length : kLengths) {
    const Matrix inverse = inverse_of(covariance_of(subject.to_lights, subject.to_lights, length));
    const double sum = (inverse.diagonal().cwiseInverse().asDiagonal() * (inverse * e)).squaredNorm();
    if (sum < least) least = sum, best = length;
  }
  return best;
}

struct Mixes::Work {
  std::vector<Lobe> lobes;
  Matrix mix;       // lobes x mixes
  Vector strength;  // variance of each mix's coefficients
  double left = 0;  // that the prior takes for noise
  Eigen::Index lights = 0;
};

Mixes::Mixes(const Subject& subject, double length, double floor, std::uint64_t seed)
    : work_(std::make_unique<Work>()) {
  Work& w = *work_;
  w.lobes = lobes_at(subject.to_lights);
  const Matrix covariance = covariance_of(subject.to_lights, subject.to_lights, length);
  const Matrix e = residuals_of(subject, covariance, floor, seed, kTaken);
  w.lights = e.rows();
  if (e.size() == 0) return;
  const auto texels = static_cast<double>(e.cols());
  const Matrix inverse = inverse_of(covariance);
  const Matrix smooth = covariance * inverse;  // K (K + 1)^-1
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
  // A component as a function: k(.)^T (K + 1)^-1 e m^T u / lambda.
  w.mix = functions_of(w.lobes, subject.to_lights, length) * (inverse * (square * (smooth.transpose() * axes)));
  for (Eigen::Index k = 0; k < count; ++k) w.mix.col(k) /= w.strength[k] * texels;
  const Matrix rest = Matrix::Identity(w.lights, w.lights) - smooth;
  w.left = (rest * square * rest.transpose()).trace();
  w.left /= texels;
}
Mixes::~Mixes() = default;
Mixes::Mixes(Mixes&&) noexcept = default;

std::size_t Mixes::size() const { return static_cast<std::size_t>(work_->strength.size()); }

Basis Mixes::first(std::size_t count) const {
  const Work& w = *work_;
  const auto taken = static_cast<Eigen::Index>(std::min(count, size()));
  Basis out;
  if (taken == 0) return out;
  out.lobes = w.lobes;
  const double noise = w.left / static_cast<double>(w.lights);  // of a light, as the prior has it
  constexpr double kFree = 1e6;
  for (Eigen::Index k = 0; k < taken; ++k) {
    out.spread.push_back(noise > 0 ? std::min(std::sqrt(w.strength[k] / noise), kFree) : kFree);
    for (Eigen::Index j = 0; j < w.mix.rows(); ++j) out.mix.push_back(w.mix(j, k));
  }
  return out;
}

}  // namespace likeness::realis
