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

}  // namespace

double half_cosine(const Samples& s, std::size_t texel, std::size_t light) {
  if (s.normals.empty() || s.to_views.empty()) return -1;
  const glm::dvec3 h = s.to_lights[light] + s.to_views[texel];
  const double length = glm::length(h);
  return length > 0 && s.normals[texel] != glm::dvec3(0) ? glm::dot(s.normals[texel], h) / length : -1;
}

Weights specular(const Samples& s, const SpecularSettings& settings) {
  Weights out(s.samples(), 1.0f);
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
