#include "olat/registration/gain.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "olat/registration/plane.h"

namespace likeness::registration {
namespace {

constexpr double kTukey = 4.685;     // 95 % efficient for normal noise
constexpr double kAboveNoise = 10;   // what counts, in sigmas of the photo's noise
constexpr std::size_t kFewest = 50;  // pixels

double tukey(double residual) {
  const double u = residual / kTukey;
  return std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
}

void require_noise(double noise) {
  if (!(noise >= 0 && std::isfinite(noise)))
    throw std::invalid_argument("registration: noise = " + std::to_string(noise) + " must be at least 0");
}

struct Ratio {
  float value, noise, weight;  // photo over render, its sigma from the photo's noise, of the pixel
};

struct Scale {
  double value = 0, scatter = 0, sigma = 0;
  std::size_t count = 0;
};

// The one number that ratios agree about.
Scale agreed(const std::vector<Ratio>& ratios) {
  if (ratios.size() < kFewest) return {};
  std::vector<float> values;
  values.reserve(ratios.size());
  for (const Ratio& r : ratios) values.push_back(r.value);
  Scale scale{static_cast<double>(quantile(values, 0.5)), 0, 0, ratios.size()};
  for (int step = 0; step < 50; ++step) {
    for (std::size_t i = 0; i < ratios.size(); ++i)
      values[i] = std::abs(ratios[i].value - static_cast<float>(scale.value));
    // What scatters beyond the noise is the render's; in proportion to light.
    std::vector<float> noises;
    noises.reserve(ratios.size());
    for (const Ratio& r : ratios) noises.push_back(r.noise);
    const double spread = 1.4826 * static_cast<double>(quantile(values, 0.5));
    const double expected = static_cast<double>(quantile(noises, 0.5));
    const double own = std::max(spread * spread - expected * expected, std::pow(1e-4 * scale.value, 2));
    double sum = 0, total = 0, squares = 0, slope = 0;
    for (const Ratio& r : ratios) {
      const double variance = own + static_cast<double>(r.noise) * static_cast<double>(r.noise);
      const double residual = static_cast<double>(r.value) - scale.value;
      const double agreement = tukey(residual / std::sqrt(variance));
      const double w = static_cast<double>(r.weight) * agreement / variance;
      sum += w * static_cast<double>(r.value);
      total += w;
      squares += w * w * variance;
      slope += agreement > 0 ? 1 : 0;
    }
    if (!(total > 0)) return {};
    const double next = sum / total, moved = std::abs(next - scale.value);
    scale = {next, std::sqrt(own), std::sqrt(squares) / total, static_cast<std::size_t>(slope)};
    if (moved <= 1e-7 * std::abs(next)) break;
  }
  return scale;
}

bool counts(std::span<const float> weight, std::size_t pixel) { return weight.empty() || weight[pixel] > 0; }
float weight_at(std::span<const float> weight, std::size_t pixel) { return weight.empty() ? 1 : weight[pixel]; }

}  // namespace

Gain gain_between(const image::Picture& photo, const image::Picture& render, std::span<const float> weight,
                  std::array<double, 3> noise) {
  require_one_size(photo, render, weight);
  for (const double n : noise) require_noise(n);
  Gain gain;
  std::vector<Ratio> all;
  std::array<std::vector<Ratio>, 3> channels;
  for (std::size_t i = 0; i < photo.rgb.size() / 3; ++i) {
    if (!counts(weight, i)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const float p = photo.rgb[3 * i + c], r = render.rgb[3 * i + c];
      if (!std::isfinite(p) || !std::isfinite(r) || !(static_cast<double>(r) > kAboveNoise * noise[c]) || !(r > 1e-20f))
        continue;
      channels[c].push_back({p / r, static_cast<float>(noise[c]) / r, weight_at(weight, i)});
    }
  }
  std::size_t measured = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const Scale scale = agreed(channels[c]);
    if (scale.count == 0 || !(scale.value > 0)) continue;
    gain.stops[c] = std::log2(scale.value);
    ++measured;
    all.insert(all.end(), channels[c].begin(), channels[c].end());
  }
  const Scale scale = agreed(all);
  if (measured == 0 || scale.count == 0 || !(scale.value > 0)) return {};
  gain.all = std::log2(scale.value);
  gain.scatter = scale.scatter / scale.value;
  gain.sigma = scale.sigma / scale.value / std::numbers::ln2;
  gain.pixels = scale.count / 3;
  return gain;
}

Curve curve_between(const image::Picture& photo, const image::Picture& render, std::span<const float> weight,
                    double noise) {
  require_one_size(photo, render, weight);
  require_noise(noise);
  const Plane seen = luminance(photo), made = luminance(render);
  const double mean_seen = weighted_mean(seen, weight), mean_made = weighted_mean(made, weight);
  if (!(mean_seen > 0 && mean_made > 0)) return {};
  // Six stops below the mean nothing of the curve is seen but ambient light. The photo's noise is put into the render's
  // unit, so that the choice does not depend on it.
  const double least = std::max(kAboveNoise * noise / mean_seen, 1.0 / 64) * mean_made;
  struct Point {
    double x, y, weight;
  };
  std::vector<Point> points;
  for (std::size_t i = 0; i < seen.values.size(); ++i)
    if (counts(weight, i) && static_cast<double>(made.values[i]) > least && seen.values[i] > 0)
      points.push_back({std::log2(static_cast<double>(made.values[i])), std::log2(static_cast<double>(seen.values[i])),
                        static_cast<double>(weight_at(weight, i))});
  if (points.size() < kFewest) return {};
  // Through the median of each eighth of the tones first: shadows and highlights are below half in each.
  std::ranges::sort(points, {}, &Point::x);
  double slope = 1, offset = 0, scatter = 0;
  {
    constexpr std::size_t kParts = 8;
    std::vector<std::array<double, 2>> medians;
    for (std::size_t k = 0; k < kParts; ++k) {
      std::vector<float> ys;
      const std::size_t first = k * points.size() / kParts, last = (k + 1) * points.size() / kParts;
      for (std::size_t i = first; i < last; ++i) ys.push_back(static_cast<float>(points[i].y));
      if (!ys.empty()) medians.push_back({points[(first + last) / 2].x, static_cast<double>(quantile(ys, 0.5))});
    }
    double x = 0, y = 0, xx = 0, xy = 0;
    for (const auto& m : medians) x += m[0], y += m[1], xx += m[0] * m[0], xy += m[0] * m[1];
    const double n = static_cast<double>(medians.size()), spread = xx - x * x / n;
    if (!(spread / n > 0.02)) return {};  // tones within 0.14 stops
    slope = (xy - x * y / n) / spread;
    offset = (y - slope * x) / n;
  }
  Curve curve;
  for (int step = 0; step < 50; ++step) {
    std::vector<float> magnitudes;
    for (const Point& p : points) magnitudes.push_back(static_cast<float>(std::abs(p.y - slope * p.x - offset)));
    scatter = std::max(1.4826 * static_cast<double>(quantile(magnitudes, 0.5)), 1e-6);
    double sum = 0, x = 0, y = 0, xx = 0, xy = 0;
    curve.pixels = 0;
    for (const Point& p : points) {
      const double agreement = tukey((p.y - slope * p.x - offset) / scatter), w = p.weight * agreement;
      curve.pixels += agreement > 0 ? 1 : 0;
      sum += w, x += w * p.x, y += w * p.y, xx += w * p.x * p.x, xy += w * p.x * p.y;
    }
    const double spread = xx - x * x / sum;
    if (!(sum > 0 && spread > 0)) return {};
    const double next = (xy - x * y / sum) / spread, moved = std::abs(next - slope);
    slope = next;
    offset = (y - slope * x) / sum;
    curve.sigma = scatter / std::sqrt(spread / 100);
    if (moved < 1e-6) break;
  }
  curve.exponent = slope;
  return curve;
}

}  // namespace likeness::registration
