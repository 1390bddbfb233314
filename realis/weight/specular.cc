#include "realis/weight/specular.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

namespace likeness::realis::weight {
namespace {

constexpr double kRing = 5, kBeyond = 45;  // [degree]
constexpr std::size_t kRings = 9;
constexpr double kLeastCosine = 0.15;

// What shines at the surface, over the light received: the mean of a texel and its neighbors, which lowers the noise of
// a difference of two photographs. NaN: not known.
class MeasuredShine {
 public:
  explicit MeasuredShine(const Samples& s)
      : s_(s), texel_of_(static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height), kNone) {
    for (std::size_t t = 0; t < s.texels(); ++t) texel_of_[s.pixels[t]] = t;
  }
  double of(std::size_t texel, std::size_t light) const {
    if (!std::isfinite(one(texel, light))) return NAN;
    const int x = static_cast<int>(s_.pixels[texel]) % s_.width, y = static_cast<int>(s_.pixels[texel]) / s_.width;
    double sum = 0, count = 0;
    for (int j = std::max(y - kReach, 0); j <= std::min(y + kReach, s_.height - 1); ++j)
      for (int i = std::max(x - kReach, 0); i <= std::min(x + kReach, s_.width - 1); ++i) {
        const std::size_t near =
            texel_of_[static_cast<std::size_t>(j) * static_cast<std::size_t>(s_.width) + static_cast<std::size_t>(i)];
        const double shine = near == kNone ? NAN : one(near, light);
        if (std::isfinite(shine)) sum += shine, ++count;
      }
    return sum / count;
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  static constexpr int kReach = 2;  // [pixel]
  double one(std::size_t texel, std::size_t light) const {
    const std::size_t at = texel * s_.lights() + light;
    const double cosine = s_.cosine.empty() ? 1 : static_cast<double>(s_.cosine[at]);
    if (!(cosine > kLeastCosine)) return NAN;
    return (luminance(s_.photo[at]) - luminance(s_.crossed[at])) / (cosine * s_.irradiance_of(light));
  }
  const Samples& s_;
  std::vector<std::size_t> texel_of_;
};

void weigh_measured(const Samples& s, const SpecularSettings& settings, Weights& out) {
  const MeasuredShine shine(s);
  const std::size_t lights = s.lights();
  std::vector<double> excess(s.samples(), NAN);
  tbb::parallel_for(std::size_t{0}, s.texels(), [&](std::size_t t) {
    std::vector<double> known;
    for (std::size_t l = 0; l < lights; ++l)
      if (const double x = shine.of(t, l); std::isfinite(x)) excess[t * lights + l] = x, known.push_back(x);
    const double least = quantile(known, 0.25);
    for (std::size_t l = 0; l < lights; ++l) excess[t * lights + l] -= least;
  });
  std::vector<double> below, shown;
  for (std::size_t at = 0; at < s.samples(); ++at) {
    if (!std::isfinite(excess[at])) continue;
    if (excess[at] <= 0) below.push_back(-excess[at]);
    const double cosine = s.cosine.empty() ? 1 : static_cast<double>(s.cosine[at]);
    shown.push_back(luminance(s.crossed[at]) / (cosine * s.irradiance_of(at % lights)));
  }
  const double noise = 1.4826 * quantile(below, 0.5);
  const double tolerance = std::max({settings.significance * noise, 0.003 * std::abs(quantile(shown, 0.5)), 1e-12});
  for (std::size_t at = 0; at < s.samples(); ++at)
    if (excess[at] > 0) out[at] = static_cast<float>(1 / (1 + (excess[at] / tolerance) * (excess[at] / tolerance)));
}

}  // namespace

double half_cosine(const Samples& s, std::size_t texel, std::size_t light) {
  if (s.normals.empty() || s.to_views.empty()) return -1;
  const glm::dvec3 h = s.to_lights[light] + s.to_views[texel];
  const double length = glm::length(h);
  return length > 0 && s.normals[texel] != glm::dvec3(0) ? glm::dot(s.normals[texel], h) / length : -1;
}

Weights specular(const Samples& s, const SpecularSettings& settings) {
  Weights out(s.samples(), 1.0f);
  if (!s.crossed.empty()) {
    weigh_measured(s, settings, out);
    return out;
  }
  if (s.normals.empty() || s.to_views.empty() || s.cosine.empty()) return out;
  const std::size_t lights = s.lights();
  // e of a sample, and its ring; kRings: beyond; one more: says nothing.
  std::vector<float> e(s.samples());
  std::vector<std::uint8_t> ring(s.samples(), kRings + 1);
  tbb::parallel_for(std::size_t{0}, s.texels(), [&](std::size_t t) {
    for (std::size_t l = 0; l < lights; ++l) {
      const std::size_t at = t * lights + l;
      const double cosine = static_cast<double>(s.cosine[at]), half = half_cosine(s, t, l);
      const double error = luminance(s.photo[at]) - luminance(s.render[at]);
      if (!(cosine > kLeastCosine) || !(half >= 0) || !std::isfinite(error)) continue;
      e[at] = static_cast<float>(error / (cosine * s.irradiance_of(l)));
      const double angle = std::acos(std::min(half, 1.0)) * 180 / std::numbers::pi;
      ring[at] = static_cast<std::uint8_t>(angle < kBeyond ? angle / kRing : kRings);
    }
  });
  // The texel's own level, and what its samples are away from it beyond the lobe.
  std::vector<double> level(s.texels());
  tbb::parallel_for(std::size_t{0}, s.texels(), [&](std::size_t t) {
    std::vector<double> beyond, all;
    for (std::size_t l = 0; l < lights; ++l)
      if (const std::size_t at = t * lights + l; ring[at] <= kRings) {
        all.push_back(static_cast<double>(e[at]));
        if (ring[at] == kRings) beyond.push_back(static_cast<double>(e[at]));
      }
    level[t] = beyond.size() >= 3 ? quantile(beyond, 0.5) : quantile(all, 0.25);
  });
  std::array<std::vector<double>, kRings + 1> excess;
  std::vector<double> shown, spread;
  for (std::size_t at = 0; at < s.samples(); ++at)
    if (ring[at] <= kRings) {
      excess[ring[at]].push_back(static_cast<double>(e[at]) - level[at / lights]);
      shown.push_back(luminance(s.photo[at]) / (static_cast<double>(s.cosine[at]) * s.irradiance_of(at % lights)));
    }
  for (const double x : excess[kRings]) spread.push_back(std::abs(x));
  const double noise = 1.4826 * quantile(spread, 0.5), least = 0.01 * std::abs(quantile(shown, 0.5));
  const double threshold = std::max({settings.significance * noise, least, 1e-12}),
               tolerance = std::max({0.5 * noise, least, 1e-12});
  std::array<double, kRings> rise{};
  for (std::size_t r = 0; r < kRings; ++r) rise[r] = quantile(excess[r], 0.5);
  const double peak = *std::max_element(rise.begin(), rise.begin() + 3);
  if (!(peak > threshold)) return out;
  std::size_t reach = 0;
  while (reach < kRings && (reach < 3 || rise[reach] > 0.5 * tolerance)) ++reach;
  tbb::parallel_for(std::size_t{0}, s.samples(), [&](std::size_t at) {
    if (ring[at] >= reach) return;
    const double x = std::max(static_cast<double>(e[at]) - level[at / lights], 0.0) / tolerance;
    out[at] = static_cast<float>(1 / (1 + x * x));
  });
  return out;
}

}  // namespace likeness::realis::weight
