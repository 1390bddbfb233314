#include "olat/pair/exposure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "brdf/lighting/zone.h"
#include "render/capture/pixels.h"

namespace likeness::olat_pair {
namespace {

constexpr double kShare = 0.99, kWhite = 1, kMostStops = 30;

double tenths(double stops) {
  const double rounded = std::floor(10 * std::clamp(stops, -kMostStops, kMostStops) + 0.5) / 10;
  return rounded == 0 ? 0 : rounded;  // never -0
}

// Luminances above a bound.
std::vector<double> lit(const image::Picture& photo, std::span<const std::uint8_t> flaws, double above) {
  constexpr unsigned kUnusable = capture::kMasked | capture::kNotFinite;
  std::vector<double> out;
  for (std::size_t i = 0; 3 * i + 2 < photo.rgb.size(); ++i) {
    if (i < flaws.size() && (flaws[i] & kUnusable) != 0) continue;
    const float* const rgb = photo.rgb.data() + 3 * i;
    const double y = 0.2126 * static_cast<double>(rgb[0]) + 0.7152 * static_cast<double>(rgb[1]) +
                     0.0722 * static_cast<double>(rgb[2]);
    if (std::isfinite(y) && y > above) out.push_back(y);
  }
  return out;
}

}  // namespace

std::optional<Exposures> exposures_of(const image::Picture& photo, std::span<const std::uint8_t> flaws, double noise) {
  std::vector<double> light = lit(photo, flaws, noise);
  if (light.empty()) light = lit(photo, flaws, 0);
  if (light.empty()) return std::nullopt;
  double sum = 0;
  for (const double y : light) sum += std::log2(y);
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(kShare * static_cast<double>(light.size()))) - 1;
  std::nth_element(light.begin(), light.begin() + rank, light.end());
  return Exposures{tenths(std::log2(kWhite / light[static_cast<std::size_t>(rank)])),
                   tenths(std::log2(brdf::Zones::kMiddleGrey) - sum / static_cast<double>(light.size()))};
}

}  // namespace likeness::olat_pair
