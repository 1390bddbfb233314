#include "realis/weight/stretch.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

namespace likeness::realis::weight {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

}  // namespace

Weights stretch(const Samples& s, const StretchSettings& settings) {
  Weights out(s.samples(), 1.0f);
  if (s.uv.empty() || s.to_views.empty()) return out;
  const auto width = static_cast<std::size_t>(s.width), height = static_cast<std::size_t>(s.height);
  std::vector<std::uint32_t> texel_at(width * height, kNone);
  for (std::size_t t = 0; t < s.texels(); ++t) texel_at[s.pixels[t]] = static_cast<std::uint32_t>(t);
  const double none = std::numeric_limits<double>::quiet_NaN();
  // The square of the texture's way from one pixel to the next along x or y, one-sided at the border of the subject; times
  // half the pixels across, it is per unit of clip space.
  const auto squared = [&](std::size_t t, std::size_t stride, std::size_t place, std::size_t count) {
    for (const bool forward : {true, false}) {
      if (forward ? place + 1 >= count : place == 0) continue;
      const std::uint32_t other = texel_at[forward ? s.pixels[t] + stride : s.pixels[t] - stride];
      if (other == kNone) continue;
      const double u = static_cast<double>(s.uv[other][0]) - static_cast<double>(s.uv[t][0]);
      const double v = static_cast<double>(s.uv[other][1]) - static_cast<double>(s.uv[t][1]);
      return (u * u + v * v) * static_cast<double>(count * count) / 4;
    }
    return none;
  };
  std::vector<double> norms(s.texels()), known;
  for (std::size_t t = 0; t < s.texels(); ++t) {
    norms[t] = std::sqrt(squared(t, 1, s.pixels[t] % width, width) + squared(t, width, s.pixels[t] / width, height));
    if (std::isfinite(norms[t])) known.push_back(norms[t]);
  }
  const double median = quantile(known, 0.5);
  if (!(median > 0)) return out;
  tbb::parallel_for(std::size_t{0}, s.texels(), [&](std::size_t t) {
    if (!std::isfinite(norms[t])) return;
    const double strength = stretch_strength(norms[t] / median, settings);
    for (std::size_t l = 0; l < s.lights(); ++l)
      out[t * s.lights() + l] = static_cast<float>(stretch_weight(strength, glm::dot(s.to_views[t], s.to_lights[l])));
  });
  return out;
}

}  // namespace likeness::realis::weight
