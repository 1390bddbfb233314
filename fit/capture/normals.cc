#include "fit/capture/normals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

namespace likeness::capture_fit {
namespace {

constexpr double kLit = 0.05;       // of the level: below it a sample is taken as in shadow at the start
constexpr double kMiddleLow = 0.3;  // ranks among the lit samples
constexpr double kMiddleHigh = 0.6;
constexpr double kWideLow = 0.2;  // where the middle would hold fewer than kEnough
constexpr double kWideHigh = 0.8;
constexpr std::size_t kEnough = 6;  // samples for 3 numbers
constexpr double kFlat = 1e-4;      // of the second moment: 0.01 rad about a plane, half a degree
constexpr int kRounds = 12;         // of weights
constexpr int kCurveRounds = 30;
constexpr double kReach = 1.5;             // of a step of the curve: its way is long and straight; 3 is too far
constexpr double kCurveStill = 1e-7;       // relative change that ends the rounds
constexpr double kStill = 1e-7;            // [1], of the normal: 0.000006 degrees
constexpr double kLeastCosine = 0.02;      // of a sample that tells about D: at smaller ones the quotient is noise
constexpr double kLeastViewCosine = 0.01;  // a camera sees what faces it
constexpr std::size_t kLeastInBin = 50;    // samples for a median
constexpr double kCurveLow = 0.25, kCurveHigh = 4;
constexpr double kMadToSigma = 1.4826;

using Matrix = Eigen::Matrix3d;
using Vector = Eigen::Vector3d;

Vector of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
glm::dvec3 of(const Vector& v) { return {v.x(), v.y(), v.z()}; }

// Sum over samples of weight e e^T, and of weight y e.
struct Moments {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, x = 0, y = 0, z = 0;
  void add(double weight, const glm::dvec3& e, double value) {
    const glm::dvec3 w = weight * e;
    xx += w.x * e.x;
    xy += w.x * e.y;
    xz += w.x * e.z;
    yy += w.y * e.y;
    yz += w.y * e.z;
    zz += w.z * e.z;
    x += w.x * value;
    y += w.y * value;
    z += w.z * value;
  }
  Matrix matrix() const { return (Matrix() << xx, xy, xz, xy, yy, yz, xz, yz, zz).finished(); }
  // False: the samples leave a direction free.
  bool solve(Vector& out) const {
    const Matrix m = matrix();
    const double trace = m.trace();
    if (!(trace > 0)) return false;
    const Eigen::LDLT<Matrix> factor(m);
    if (!(factor.vectorD().minCoeff() > 1e-3 * kFlat * trace)) return false;
    out = factor.solve(Vector(x, y, z));
    return out.allFinite();
  }
};

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// albedo times normal, over pi, from the middle of the ranks.
bool start_of(const Site& site, std::span<const double> y, double level, std::vector<double>& lit, Vector& b) {
  // Ranks are of brightness over irradiance, so that the distance of a near light is no rank.
  const auto unit = [&](std::size_t k) { return y[k] / site.shines[k].irradiance; };
  lit.clear();
  for (std::size_t k = 0; k < y.size(); ++k)
    if (y[k] > kLit * level && site.shines[k].irradiance > 0) lit.push_back(unit(k));
  std::sort(lit.begin(), lit.end());
  const double last = static_cast<double>(lit.size()) - 1;
  for (const auto& [from, to] : {std::pair{kMiddleLow, kMiddleHigh}, {kWideLow, kWideHigh}, {0.0, 1.0}}) {
    if (lit.empty()) return false;
    const double low = lit[static_cast<std::size_t>(std::ceil(from * last))];
    const double high = lit[static_cast<std::size_t>(std::floor(to * last))];
    Moments m;
    std::size_t count = 0;
    for (std::size_t k = 0; k < y.size(); ++k) {
      if (!(y[k] > kLit * level) || !(site.shines[k].irradiance > 0) || unit(k) < low || unit(k) > high) continue;
      m.add(1, site.shines[k].to_light, unit(k));
      ++count;
    }
    if ((count >= kEnough || to == 1) && m.solve(b)) return true;
  }
  return false;
}

// One round of weights and least squares about b. False where nothing is left to solve.
struct Round {
  const Site& site;
  std::span<const double> y;
  const Curve& curve;
  double floor;  // of the scale [brightness]: rounding of the photos
  Workspace& work;
  double scale = 0;
  Moments moments{};

  bool counts(const glm::dvec3& b, std::size_t k) const {
    return std::isfinite(y[k]) && site.shines[k].irradiance > 0 && glm::dot(b, site.shines[k].to_light) > 0;
  }
  double predicted(const glm::dvec3& b, double length, std::size_t k, double& d) const {
    const auto& [to_light, irradiance] = site.shines[k];
    const double facing = glm::dot(b, to_light);
    d = curve.at(facing / length) * irradiance;
    return facing * d;
  }
  bool improve(Vector& at) {
    const glm::dvec3 b = of(at);
    const double length = glm::length(b);
    if (!(length > 0)) return false;
    work.weights.assign(y.size(), 0);
    work.scratch.clear();
    for (std::size_t k = 0; k < y.size(); ++k) {
      if (!counts(b, k)) continue;
      double d = 0;
      work.weights[k] = y[k] - predicted(b, length, k, d);
      work.scratch.push_back(std::abs(work.weights[k]));
    }
    if (work.scratch.size() < 3) return false;
    scale = std::max(kMadToSigma * median_of(work.scratch), floor);
    moments = {};
    for (std::size_t k = 0; k < y.size(); ++k) {
      const double facing = glm::dot(b, site.shines[k].to_light);
      if (!counts(b, k)) {
        work.weights[k] = 0;
        continue;
      }
      const double residual = work.weights[k] / scale;
      work.weights[k] = 1 / (1 + residual * residual);
      const double d = curve.at(facing / length) * site.shines[k].irradiance;
      moments.add(work.weights[k] * d * d, site.shines[k].to_light, y[k] / d);
    }
    return moments.solve(at);
  }
};

double error_of(const Round& round, const Vector& b) {
  double squares = 0, weights = 0;
  const double length = b.norm();
  for (std::size_t k = 0; k < round.y.size(); ++k) {
    if (!(round.work.weights[k] > 0)) continue;
    double d = 0;
    const double r = round.y[k] - round.predicted(of(b), length, k, d);
    squares += round.work.weights[k] * r * r;
    weights += round.work.weights[k];
  }
  const Vector n = b / length;
  const Matrix across = Matrix::Identity() - n * n.transpose();
  const double variance = squares / std::max(weights - 3, 1.0);
  const Matrix covariance = variance * round.moments.matrix().inverse();
  return std::sqrt(std::max((across * covariance * across).trace(), 0.0)) / length;
}

struct Solved {
  Vector b{0, 0, 0};
  double sigma = 0;
};
bool solve_pixel(const Site& site, std::span<const double> y, double level, const Curve& curve, int rounds,
                 const Vector* from, Workspace& work, Solved& out) {
  if (from) out.b = *from;
  else if (!start_of(site, y, level, work.scratch, out.b)) return false;
  Round round{site, y, curve, 1e-7 * level, work};
  for (int i = 0; i < rounds; ++i) {
    Vector next = out.b;
    if (!round.improve(next)) return i > 0 || from != nullptr;
    const double moved = (next.normalized() - out.b.normalized()).norm();
    out.b = next;
    if (moved < kStill) break;
  }
  out.sigma = error_of(round, out.b);
  return true;
}

}  // namespace

double Curve::at(double cosine) const {
  const double x = std::clamp(cosine, 0.0, 1.0) * static_cast<double>(kBins);
  const auto i = std::min(static_cast<std::size_t>(x), kBins - 1);
  const double t = x - static_cast<double>(i);
  return values[i] + t * (values[i + 1] - values[i]);
}

void brightness_of(const Stack& stack, std::size_t pixel, std::vector<double>& out) {
  const auto r = stack.of(pixel, 0), g = stack.of(pixel, 1), b = stack.of(pixel, 2);
  out.resize(r.size());
  for (std::size_t k = 0; k < r.size(); ++k)
    out[k] = (static_cast<double>(r[k]) + static_cast<double>(g[k]) + static_cast<double>(b[k])) / 3;
}

double level_of(std::span<const double> brightness, std::vector<double>& scratch) {
  scratch.clear();
  for (const double y : brightness)
    if (y > 0) scratch.push_back(y);
  if (scratch.empty()) return 0;
  const std::size_t above = scratch.size() == 1 ? 0 : std::max<std::size_t>(1, scratch.size() / 10);
  const auto at = scratch.begin() + static_cast<std::ptrdiff_t>(scratch.size() - 1 - above);
  std::nth_element(scratch.begin(), at, scratch.end());
  return *at;
}

Seen seen_by(const Site& site, std::span<const double> brightness, double noise) {
  Matrix spread = Matrix::Zero();
  int count = 0;
  for (std::size_t k = 0; k < brightness.size(); ++k) {
    if (!(brightness[k] > noise) || !(site.shines[k].irradiance > 0)) continue;
    const Vector l = of(site.shines[k].to_light);
    spread += l * l.transpose();
    ++count;
  }
  if (count == 0) return Seen::kByNone;
  if (count < 3) return Seen::kByFew;
  // The smallest eigenvalue of a symmetric matrix that has no negative one; computeDirect loses what is this small.
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(spread, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()[0] > kFlat * count ? Seen::kWell : Seen::kInOnePlane;
}

NormalOfPixel normal_of(const Site& site, std::span<const double> brightness, double noise, const Curve& curve,
                        Workspace& work) {
  NormalOfPixel out;
  out.seen = seen_by(site, brightness, noise);
  if (out.seen != Seen::kWell) return out;
  Solved solved;
  const double level = level_of(brightness, work.scratch);
  if (!solve_pixel(site, brightness, level, curve, kRounds, nullptr, work, solved) || !(solved.b.norm() > 0)) {
    out.seen = Seen::kInOnePlane;  // the samples that are lit at all are fewer than those above the noise
    return out;
  }
  out.albedo = solved.b.norm() * std::numbers::pi;
  out.sigma = solved.sigma;
  glm::dvec3 n = glm::normalize(of(solved.b));
  const double towards = glm::dot(n, site.to_view);
  if (towards < kLeastViewCosine) {
    const glm::dvec3 along = n - towards * site.to_view;
    if (!(glm::length(along) > 1e-6)) return {.seen = out.seen};
    n = glm::normalize(glm::normalize(along) + kLeastViewCosine * site.to_view);
  }
  out.normal = n;
  return out;
}

Curve curve_of(const Stack& sample, const Sites& sites, double noise) {
  struct Pixel {
    Workspace work;
    double level = 0;
    Solved solved;
    bool is_known = false;
  };
  std::vector<Pixel> pixels(sample.pixels.size());
  Curve curve;
  std::array<std::vector<double>, Curve::kBins + 1> quotients;
  for (int round = 0; round < kCurveRounds; ++round) {
    tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
      Pixel& p = pixels[i];
      if (round == 0) {
        sites.at(sample.pixels[i], p.work.site);
        brightness_of(sample, i, p.work.y);
        p.level = level_of(p.work.y, p.work.scratch);
        p.is_known = seen_by(p.work.site, p.work.y, noise) == Seen::kWell;
      }
      if (!p.is_known) return;
      p.is_known =
          solve_pixel(p.work.site, p.work.y, p.level, curve, 1, round == 0 ? nullptr : &p.solved.b, p.work, p.solved);
    });
    for (auto& bin : quotients) bin.clear();
    for (const Pixel& p : pixels) {
      if (!p.is_known) continue;
      const glm::dvec3 b = of(p.solved.b);
      const double length = glm::length(b);
      for (std::size_t k = 0; k < p.work.y.size(); ++k) {
        const auto& [to_light, irradiance] = p.work.site.shines[k];
        const double cosine = glm::dot(b, to_light) / length;
        const double quotient = p.work.y[k] / (cosine * length * irradiance);
        if (!(cosine > kLeastCosine) || !std::isfinite(quotient)) continue;
        quotients[static_cast<std::size_t>(std::lround(std::min(cosine, 1.0) * double(Curve::kBins)))].push_back(
            quotient);
      }
    }
    const Curve before = curve;
    // Bins with few samples take the value of the nearest that has enough.
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    double sum = 0, count = 0;
    for (std::size_t i = 0; i <= Curve::kBins; ++i) {
      const bool is_enough = quotients[i].size() >= kLeastInBin;
      curve.values[i] = is_enough ? median_of(quotients[i]) : kNone;
      if (!is_enough) continue;
      sum += curve.values[i] * static_cast<double>(quotients[i].size());
      count += static_cast<double>(quotients[i].size());
    }
    if (!(sum > 0)) return Curve();
    const auto known = curve.values;
    double moved = 0;
    for (std::size_t i = 0; i <= Curve::kBins; ++i) {
      for (std::size_t away = 0; std::isnan(curve.values[i]); ++away) {
        if (i >= away && !std::isnan(known[i - away])) curve.values[i] = known[i - away];
        else if (i + away <= Curve::kBins && !std::isnan(known[i + away])) curve.values[i] = known[i + away];
      }
      const double step = std::clamp(curve.values[i] * count / sum, kCurveLow, kCurveHigh) / before.values[i];
      curve.values[i] = std::clamp(before.values[i] * std::pow(step, kReach), kCurveLow, kCurveHigh);
      moved = std::max(moved, std::abs(step - 1));
    }
    if (moved < kCurveStill) break;
  }
  return curve;
}

}  // namespace likeness::capture_fit
