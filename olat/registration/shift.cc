#include "olat/registration/shift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "olat/registration/plane.h"

namespace likeness::registration {
namespace {

constexpr float kBlur =
    1;  // [pixel], of both pictures: what interpolation then does to noise and edges is below 0.01 pixel
constexpr std::size_t kFewestPixels = 200;  // pixels, for a shift to be told
constexpr std::size_t kMost = 60'000;       // pixels that a level looks at: sigma is then far below 0.01 pixel
constexpr double kLeastAgreement = 0.5;     // correlation: two pictures of noise have 0.1, the worst render 0.8
constexpr double kCauchy = 2.385;           // 95 % efficient for normal noise
constexpr double kLogOfE = 1.0 / std::numbers::ln2;

// log2 of light above a floor that keeps shadows from being all noise.
Plane log_light(const Plane& light, double floor) {
  Plane out = light;
  for (float& v : out.values) v = std::log2(std::max(v, 0.0f) + static_cast<float>(floor));
  return out;
}

// 1 where all within `radius` (a square) weigh more than 0, and lie in the picture.
Plane inside(const Plane& weight, int radius) {
  Plane rows(weight.width, weight.height), out(weight.width, weight.height);
  const auto runs = [&](int count, const auto& value, const auto& store) {
    int run = 0;
    for (int i = 0; i < count; ++i) {
      run = value(i) > 0 ? run + 1 : 0;
      if (run > 2 * radius) store(i - radius);
    }
  };
  for (int y = 0; y < weight.height; ++y)
    runs(weight.width, [&](int x) { return weight.at(x, y); }, [&](int x) { rows.at(x, y) = 1; });
  for (int x = 0; x < weight.width; ++x)
    runs(weight.height, [&](int y) { return rows.at(x, y); }, [&](int y) { out.at(x, y) = 1; });
  return out;
}

struct Taste {
  float value, dx, dy;
};

// Catmull-Rom, and its slopes. Two pixels of margin are needed.
Taste taste(const Plane& plane, double x, double y) {
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto weights = [](float t) {
    return std::array{0.5f * (-t + 2 * t * t - t * t * t), 0.5f * (2 - 5 * t * t + 3 * t * t * t),
                      0.5f * (t + 4 * t * t - 3 * t * t * t), 0.5f * (-t * t + t * t * t)};
  };
  const auto slopes = [](float t) {
    return std::array{0.5f * (-1 + 4 * t - 3 * t * t), 0.5f * (-10 * t + 9 * t * t), 0.5f * (1 + 8 * t - 9 * t * t),
                      0.5f * (-2 * t + 3 * t * t)};
  };
  const float tx = static_cast<float>(x - x0), ty = static_cast<float>(y - y0);
  const auto wx = weights(tx), wy = weights(ty), sx = slopes(tx), sy = slopes(ty);
  Taste out{0, 0, 0};
  for (int j = 0; j < 4; ++j) {
    float value = 0, slope = 0;
    for (int i = 0; i < 4; ++i) {
      const float v = plane.at(x0 - 1 + i, y0 - 1 + j);
      value += wx[static_cast<std::size_t>(i)] * v;
      slope += sx[static_cast<std::size_t>(i)] * v;
    }
    out.value += wy[static_cast<std::size_t>(j)] * value;
    out.dx += wy[static_cast<std::size_t>(j)] * slope;
    out.dy += sy[static_cast<std::size_t>(j)] * value;
  }
  return out;
}

struct Level {
  Plane photo, render, weight;
};

struct Sample {
  Eigen::Vector3d slope;  // of the render's value with x, y, gain
  double render, residual;
};

// A level's pixels that are compared, and what the steps know of them.
struct Estimate {
  double x = 0, y = 0, gain = 0;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double agreement = 0;  // correlation of what is compared, with the weights of the steps
  std::size_t pixels = 0;
};

std::vector<std::array<int, 2>> pixels_of(const Plane& inner, int margin, double& spacing) {
  std::size_t count = 0;
  for (const float w : inner.values) count += w > 0 ? 1 : 0;
  const int stride = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count) / kMost))));
  spacing = stride;
  std::vector<std::array<int, 2>> pixels;
  for (int y = margin; y < inner.height - margin; y += stride)
    for (int x = margin; x < inner.width - margin; x += stride)
      if (inner.at(x, y) > 0) pixels.push_back({x, y});
  return pixels;
}

double median_magnitude(const std::vector<Sample>& samples) {
  std::vector<float> magnitudes;
  magnitudes.reserve(samples.size());
  for (const Sample& s : samples) magnitudes.push_back(static_cast<float>(std::abs(s.residual)));
  return static_cast<double>(quantile(magnitudes, 0.5));
}

double cauchy(double residual, double scatter) {
  const double out = residual / (kCauchy * scatter);
  return 1 / (1 + out * out);
}

double correlation(const std::vector<Sample>& samples, double scatter) {
  double total = 0, p = 0, r = 0, pp = 0, rr = 0, pr = 0;
  for (const Sample& s : samples) {
    const double w = cauchy(s.residual, scatter), seen = s.render + s.residual;
    total += w, p += w * seen, r += w * s.render;
    pp += w * seen * seen, rr += w * s.render * s.render, pr += w * seen * s.render;
  }
  const double both = (pp - p * p / total) * (rr - r * r / total);
  return both > 0 ? (pr - p * r / total) / std::sqrt(both) : 0;
}

// Where to begin: the whole number of pixels at which the two correlate best.
void search(const Level& level, Estimate& estimate) {
  const int reach = std::min(level.photo.width, level.photo.height) / 8 + 1;
  double spacing = 1;
  for (const int radius : {reach + 2, reach / 2 + 1, 1}) {
    const auto pixels = pixels_of(inside(level.weight, radius), reach, spacing);
    if (pixels.size() < kFewestPixels) continue;
    double best = 0;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        double p = 0, r = 0, pp = 0, rr = 0, pr = 0;
        for (const auto& [x, y] : pixels) {
          const double seen = static_cast<double>(level.photo.at(x, y));
          const double made = static_cast<double>(level.render.at(x - dx, y - dy));
          p += seen, r += made, pp += seen * seen, rr += made * made, pr += seen * made;
        }
        const double n = static_cast<double>(pixels.size()), both = (pp - p * p / n) * (rr - r * r / n);
        const double found = both > 0 ? (pr - p * r / n) / std::sqrt(both) : 0;
        if (found > best) best = found, estimate.x = dx, estimate.y = dy;
      }
    return;
  }
}

// Steps from `estimate` until they are small. The gain is started at the median, since it may be anything.
void refine(const Level& level, const Plane& inner, Estimate& estimate) {
  double spacing = 1;
  const auto pixels = pixels_of(inner, 2, spacing);
  estimate.pixels = 0;
  if (pixels.size() < kFewestPixels) return;
  std::vector<Sample> samples;
  for (int step = 0; step < 30; ++step) {
    samples.clear();
    std::vector<float> offsets;
    for (const auto& [x, y] : pixels) {
      const double u = x - estimate.x, v = y - estimate.y;
      if (u < 2 || v < 2 || u > level.render.width - 3 || v > level.render.height - 3) continue;
      const Taste r = taste(level.render, u, v);
      const double residual = static_cast<double>(level.photo.at(x, y) - r.value);
      samples.push_back(
          {{-static_cast<double>(r.dx), -static_cast<double>(r.dy), 1}, static_cast<double>(r.value), residual});
      if (step == 0) offsets.push_back(static_cast<float>(residual));
    }
    if (samples.size() < kFewestPixels) return;
    if (step == 0) estimate.gain = static_cast<double>(quantile(offsets, 0.5));
    for (Sample& s : samples) s.residual -= estimate.gain;
    const double scatter = std::max(1.4826 * median_magnitude(samples), 1e-7);
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d pull = Eigen::Vector3d::Zero();
    for (const Sample& s : samples) {
      const double weight = cauchy(s.residual, scatter);
      information += weight * s.slope * s.slope.transpose();
      pull += weight * s.residual * s.slope;
    }
    // A direction without slope is left alone: its eigenvalue is far below that of noise.
    const Eigen::Matrix3d damped = information + 1e-9 * information.trace() * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d delta = damped.inverse() * pull;
    const double length = std::hypot(delta.x(), delta.y()), reach = std::min(1.0, 1.0 / std::max(length, 1e-12));
    estimate.x += reach * delta.x();
    estimate.y += reach * delta.y();
    estimate.gain += reach * delta.z();
    // Blurred noise is the same over 4 pi sigma^2 pixels.
    const double repeated = std::max(1.0, 4 * std::numbers::pi * kBlur * kBlur / (spacing * spacing));
    estimate.information = information / (scatter * scatter * repeated);
    estimate.agreement = correlation(samples, scatter);
    estimate.pixels = samples.size();
    if (length < 1e-4) break;
  }
}

}  // namespace

double Shift::sigma() const {
  if (!is_measured()) return std::numeric_limits<double>::infinity();
  const double middle = 0.5 * (xx + yy), apart = std::hypot(0.5 * (xx - yy), xy);
  return std::sqrt(std::max(0.0, middle + apart));
}

double Shift::length() const { return std::hypot(x, y); }

Shift shift_between(const image::Picture& photo, const image::Picture& render, std::span<const float> weight,
                    double noise) {
  require_one_size(photo, render, weight);
  if (photo.width < 16 || photo.height < 16) return {};
  Plane weights(photo.width, photo.height);
  for (std::size_t i = 0; i < weights.values.size(); ++i) weights.values[i] = weight.empty() ? 1 : weight[i];
  const Plane seen = luminance(photo), made = luminance(render);
  const double mean_seen = weighted_mean(seen, weight), mean_made = weighted_mean(made, weight);
  if (!(mean_seen > 0 && mean_made > 0)) return {};
  // The same floor, in proportion to each picture's light.
  const double floor = std::max(0.05, 4 * noise / mean_seen);
  std::vector<Level> levels;
  levels.push_back({log_light(blurred(seen, kBlur), floor * mean_seen),
                    log_light(blurred(made, kBlur), floor * mean_made), weights});
  while (std::min(levels.back().photo.width, levels.back().photo.height) >= 128 && levels.size() < 8) {
    const Level& fine = levels.back();
    Level coarse{halved(fine.photo), halved(fine.render), halved(fine.weight)};
    for (int y = 0; y < coarse.weight.height; ++y)
      for (int x = 0; x < coarse.weight.width; ++x)
        coarse.weight.at(x, y) = std::min({fine.weight.at(2 * x, 2 * y), fine.weight.at(2 * x + 1, 2 * y),
                                           fine.weight.at(2 * x, 2 * y + 1), fine.weight.at(2 * x + 1, 2 * y + 1)});
    levels.push_back(std::move(coarse));
  }

  Estimate estimate;
  search(levels.back(), estimate);
  for (std::size_t k = levels.size(); k-- > 0;) {
    if (k + 1 < levels.size()) {
      estimate.x *= 2;
      estimate.y *= 2;
    }
    const auto reach = static_cast<int>(std::ceil(std::hypot(estimate.x, estimate.y)));
    const int blur = k == 0 ? static_cast<int>(std::ceil(3 * kBlur)) : 2;
    // As far from the border as the render may have moved; closer where the subject is small.
    for (const int radius : {blur + reach + 2, blur, 1}) {
      Estimate next = estimate;
      refine(levels[k], inside(levels[k].weight, radius), next);
      if (next.pixels == 0) continue;
      estimate = next;
      break;
    }
  }

  Shift shift{.x = estimate.x, .y = estimate.y};
  const double limit = std::min(photo.width, photo.height) / 8.0;
  if (estimate.pixels == 0 || estimate.agreement < kLeastAgreement || !(shift.length() <= limit)) return {};
  // What the gain explains is not the shift's.
  const Eigen::Matrix2d own = estimate.information.topLeftCorner<2, 2>() -
                              estimate.information.topRightCorner<2, 1>() *
                                  estimate.information.bottomLeftCorner<1, 2>() / estimate.information(2, 2);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(own);
  // One sigma of 3 pixels is no measurement; in the other direction it may be one.
  const Eigen::Vector2d values = solver.eigenvalues().cwiseMax(1.0 / 9);
  if (!(solver.eigenvalues()[1] > 1) || !std::isfinite(values.sum())) return {};
  const Eigen::Matrix2d covariance =
      solver.eigenvectors() * values.cwiseInverse().asDiagonal() * solver.eigenvectors().transpose();
  shift.xx = covariance(0, 0);
  shift.xy = covariance(0, 1);
  shift.yy = covariance(1, 1);
  shift.pixels = estimate.pixels;
  return shift;
}

Shift combined(std::span<const Shift> shifts) {
  // What the numbers of one pair do not say of its errors: light that is wrong everywhere. [pixel]
  constexpr double kLeastSigma = 0.02;
  struct Known {
    Eigen::Vector2d at;
    Eigen::Matrix2d information;
  };
  std::vector<Known> known;
  std::size_t pixels = 0;
  for (const Shift& s : shifts) {
    if (!s.is_measured()) continue;
    Eigen::Matrix2d covariance;
    covariance << s.xx + kLeastSigma * kLeastSigma, s.xy, s.xy, s.yy + kLeastSigma * kLeastSigma;
    known.push_back({{s.x, s.y}, covariance.inverse()});
    pixels += s.pixels;
  }
  if (known.empty()) return {};
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information;
  double excess = 1;
  std::vector<double> weights(known.size(), 1.0);
  for (int step = 0; step < 20; ++step) {
    information.setZero();
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < known.size(); ++i) {
      information += weights[i] * known[i].information;
      sum += weights[i] * known[i].information * known[i].at;
    }
    mean = information.inverse() * sum;
    std::vector<float> apart;
    for (const Known& k : known) apart.push_back(static_cast<float>((k.at - mean).dot(k.information * (k.at - mean))));
    std::vector<float> sorted = apart;
    // The median of chi squared of two dimensions is 2 ln 2.
    excess = std::max(1.0, static_cast<double>(quantile(sorted, 0.5)) * kLogOfE / 2);
    for (std::size_t i = 0; i < known.size(); ++i)
      weights[i] = 1 / (1 + static_cast<double>(apart[i]) / (excess * kCauchy * kCauchy));
  }
  const Eigen::Matrix2d covariance = excess * information.inverse();
  return {mean.x(), mean.y(), covariance(0, 0), covariance(0, 1), covariance(1, 1), pixels};
}

}  // namespace likeness::registration
