#include "realis/choose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <glm/geometric.hpp>

namespace likeness::realis {
namespace {

using Matrix = Eigen::MatrixXd;

constexpr std::size_t kScales = 4, kFewest = 6;  // lobes below which there is one scale
constexpr double kExactSpread = 1e6;
constexpr double kNoiseShare = 2e-3;  // of the brightest photo: what stops are counted above

// How many lobes each scale has, narrow ones first.
std::vector<std::size_t> counts_of(std::size_t count, std::size_t lights) {
  std::vector<std::size_t> counts;
  if (count < kFewest) return {std::min(count, lights)};
  // A fourth on each wider scale: the narrowest has three fourths of all, or all lights.
  std::size_t rest = count;
  while (rest > 0 && counts.size() < kScales) {
    const bool last = counts.size() + 1 == kScales || rest < 4;
    const std::size_t here = std::min(lights, last ? rest : (3 * rest + 3) / 4);
    counts.push_back(here);
    rest -= here;
  }
  return counts;
}

// The median angle from an axis to its nearest neighbour; of one axis: to the farthest direction.
double spacing_of(std::span<const glm::dvec3> axes, std::span<const glm::dvec3> directions) {
  const auto angle = [](const glm::dvec3& a, const glm::dvec3& b) {
    return 2 * std::asin(std::min(1.0, 0.5 * glm::length(a - b)));
  };
  std::vector<double> nearest;
  if (axes.size() == 1) {
    double farthest = 0;
    for (const glm::dvec3& d : directions) farthest = std::max(farthest, angle(axes[0], d));
    return std::clamp(farthest, 0.01, std::numbers::pi);
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    double least = std::numbers::pi;
    for (std::size_t k = 0; k < axes.size(); ++k)
      if (k != i) least = std::min(least, angle(axes[i], axes[k]));
    nearest.push_back(least);
  }
  std::nth_element(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2), nearest.end());
  return std::clamp(nearest[nearest.size() / 2], 1e-3, std::numbers::pi);
}
double sharpness_at_half(double angle) { return std::numbers::ln2 / (1 - std::cos(angle)); }

struct Scale {
  std::vector<glm::dvec3> axes;
  double sharpness;
};

class Search {
 public:
  Search(const Sampled& sampled, std::vector<Scale> scales)
      : sampled_(sampled),
        scales_(std::move(scales)),
        residuals_(Eigen::Map<const Eigen::MatrixXf>(sampled.residuals.data(),
                                                     static_cast<Eigen::Index>(sampled.to_lights.size()),
                                                     static_cast<Eigen::Index>(sampled.texels()))
                       .cast<double>()) {
    if (sampled.weights.size() == sampled.residuals.size() && !sampled.weights.empty()) trust(sampled);
    if (sampled.photos.size() != sampled.residuals.size()) return;
    photos_ = Eigen::Map<const Eigen::MatrixXf>(sampled.photos.data(), residuals_.rows(), residuals_.cols())
                  .cast<double>()
                  .cwiseMax(0);
    noise_ = kNoiseShare * photos_.maxCoeff();
    if (!(noise_ > 0)) photos_.resize(0, 0);
  }

  // Logarithms: of the factor of all sharpnesses, then of the spread of each scale over a residual's typical noise.
  std::size_t size() const { return 1 + scales_.size(); }

  Basis basis(std::span<const double> x) const {
    Basis out;
    for (std::size_t s = 0; s < scales_.size(); ++s)
      for (const glm::dvec3& axis : scales_[s].axes) {
        out.lobes.push_back({axis, scales_[s].sharpness * std::exp(x[0])});
        out.spread.push_back(std::exp(x[1 + s]));
      }
    return out;
  }

  struct Score {
    double held_out = std::numeric_limits<double>::infinity();  // root mean square
    double stops = 1;    // root mean square, if there are photos: a shadow is little light, and many stops
    double freedom = 1;  // degrees of freedom of the fit over the number of lights
    // Lobes that are narrower than the distance of two lights can repeat each light's noise without any harm to the
    // others, and stops are few texels' affair: what is wholly free must foretell by 2 % better than what is not at all.
    double value() const { return held_out * stops * (1 + 2e-2 * freedom); }
  };
  Score score(std::span<const double> x) const {
    const Basis b = basis(x);
    const std::vector<double> rows = values(b.lobes, sampled_.to_lights);
    const auto lights = residuals_.rows(), lobes = static_cast<Eigen::Index>(b.lobes.size());
    Matrix scaled = Eigen::Map<const Matrix>(rows.data(), lobes, lights);
    for (Eigen::Index k = 0; k < lobes; ++k) scaled.row(k) *= b.spread[static_cast<std::size_t>(k)];
    Matrix system = Matrix::Identity(lights, lights);
    system.selfadjointView<Eigen::Lower>().rankUpdate(scaled.transpose());
    const Eigen::LLT<Matrix> factor(system);
    const Matrix inverse = factor.solve(Matrix::Identity(lights, lights));
    const Matrix left = inverse.diagonal().cwiseInverse().asDiagonal() * (inverse * residuals_);
    const double mean = mean_of(left.array().square());
    if (!std::isfinite(mean)) return {};
    return {std::sqrt(mean), stops(left), 1 - inverse.trace() / static_cast<double>(std::max<Eigen::Index>(lights, 1))};
  }

  double stops(const Matrix& left) const {
    if (photos_.size() == 0) return 1;
    const auto predicted = (photos_ - left).array().max(0) + noise_;
    const double mean = mean_of((predicted / (photos_.array() + noise_)).log().square());
    return std::sqrt(mean) / std::numbers::ln2 + 1e-6;
  }

  double plain() const { return std::sqrt(mean_of(residuals_.array().square())); }

 private:
  template <class Squares>
  double mean_of(const Squares& squares) const {
    if (weights_.size() == 0) return squares.sum() / static_cast<double>(std::max<Eigen::Index>(squares.size(), 1));
    return (weights_.array() * squares).sum() / std::max(weights_.sum(), 1e-12);
  }

  // What is not trusted is replaced by the mean of the texel's other lights, near ones first (one over the square of the
  // distance), as far as it is not.
  void trust(const Sampled& sampled) {
    weights_ =
        Eigen::Map<const Eigen::MatrixXf>(sampled.weights.data(), residuals_.rows(), residuals_.cols()).cast<double>();
    Matrix nearness = Matrix::Zero(residuals_.rows(), residuals_.rows());
    for (Eigen::Index i = 0; i < nearness.rows(); ++i)
      for (Eigen::Index k = 0; k < nearness.rows(); ++k) {
        const glm::dvec3 way =
            sampled.to_lights[static_cast<std::size_t>(i)] - sampled.to_lights[static_cast<std::size_t>(k)];
        if (i != k) nearness(i, k) = 1 / (glm::dot(way, way) + 1e-6);
      }
    const Matrix sums = nearness * weights_, means = nearness * weights_.cwiseProduct(residuals_);
    for (Eigen::Index i = 0; i < residuals_.size(); ++i) {
      const double w = weights_(i), around = sums(i) > 0 ? means(i) / sums(i) : 0;
      residuals_(i) = w * (w > 0 ? residuals_(i) : 0) + (1 - w) * around;
    }
  }

  const Sampled& sampled_;
  std::vector<Scale> scales_;
  Matrix residuals_;  // lights x texels
  Matrix photos_;     // likewise, or empty
  Matrix weights_;    // likewise
  double noise_ = 0;
};

// Tries a step up and a step down along each coordinate, and halves the steps when none helps.
std::vector<double> compass(const Search& search, double& held_out) {
  constexpr double kFirst = 1.5, kLast = 0.1, kWidest = 12;
  std::vector<double> x(search.size(), 0.0);
  Search::Score best = search.score(x);
  for (double step = kFirst; step > kLast; step *= 0.5)
    for (bool helped = true; helped;) {
      helped = false;
      for (std::size_t i = 0; i < x.size(); ++i)
        for (const double sign : {1.0, -1.0}) {
          std::vector<double> y = x;
          y[i] = std::clamp(y[i] + sign * step, i == 0 ? -2.0 : -kWidest, i == 0 ? 2.0 : kWidest);
          if (y[i] == x[i]) continue;
          const Search::Score found = search.score(y);
          if (found.value() < best.value() * (1 - 1e-5)) {
            best = found, x = y, helped = true;
            break;
          }
        }
    }
  held_out = best.held_out;
  return x;
}

}  // namespace

Choice choose_basis(const Sampled& sampled, std::size_t count) {
  Choice choice;
  if (sampled.texels() == 0 || count == 0) return choice;
  std::vector<Scale> scales;
  const std::size_t lights = spread_out(sampled.to_lights, sampled.to_lights.size()).size();
  for (const std::size_t here : counts_of(count, lights)) {
    Scale scale;
    scale.axes = spread_out(sampled.to_lights, here);
    scale.sharpness = sharpness_at_half(spacing_of(scale.axes, sampled.to_lights));
    // Of two scales that have all lights for axes the second is wider, too.
    if (!scales.empty()) scale.sharpness = std::min(scale.sharpness, 0.25 * scales.back().sharpness);
    scales.push_back(std::move(scale));
  }
  const Search search(sampled, std::move(scales));
  choice.plain = search.plain();
  choice.basis = search.basis(compass(search, choice.held_out));
  return choice;
}

Basis exact_basis(std::span<const glm::dvec3> to_lights) {
  Basis basis;
  const std::vector<glm::dvec3> axes = spread_out(to_lights, to_lights.size());
  if (axes.empty()) return basis;
  const double sharpness = sharpness_at_half(spacing_of(axes, to_lights));
  for (const glm::dvec3& axis : axes) basis.lobes.push_back({axis, sharpness}), basis.spread.push_back(kExactSpread);
  return basis;
}

std::vector<Choice> ladder(const Sampled& sampled, std::size_t most, const std::function<void(double)>& tell) {
  constexpr std::array<std::size_t, 16> kRungs{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256};
  std::vector<Choice> out;
  const auto rungs = static_cast<double>(std::upper_bound(kRungs.begin(), kRungs.end(), most) - kRungs.begin());
  for (const std::size_t count : kRungs) {
    if (count > most) break;
    Choice choice = choose_basis(sampled, count);
    if (!out.empty() && choice.basis.lobes.size() == out.back().basis.lobes.size()) break;  // there are no more lights
    out.push_back(std::move(choice));
    tell(static_cast<double>(out.size()) / rungs);
  }
  return out;
}

std::size_t chosen_of(std::span<const Choice> ladder, double tolerance) {
  double best = std::numeric_limits<double>::infinity();
  for (const Choice& choice : ladder) best = std::min(best, choice.held_out);
  for (std::size_t i = 0; i < ladder.size(); ++i)
    if (ladder[i].held_out <= (1 + tolerance) * best) return i;
  return 0;
}

}  // namespace likeness::realis
