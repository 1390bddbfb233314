#include "olat/pair/exposure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "render/capture/pixels.h"
#include "render/exposure/pick.h"

namespace likeness::olat_pair {
namespace {

constexpr double kShare = 0.99, kMostStops = 30;

double tenths(double stops) {
  const double rounded = std::floor(10 * std::clamp(stops, -kMostStops, kMostStops) + 0.5) / 10;
  return rounded == 0 ? 0 : rounded;  // never -0
}

// 1 for pixels that count. An infinite one does not, whether it was marked or not: it would be the brightest.
std::vector<float> weights_of(const image::Picture& photo, std::span<const std::uint8_t> flaws) {
  constexpr unsigned kUnusable = capture::kMasked | capture::kNotFinite;
  std::vector<float> out(photo.rgb.size() / 3, 1);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float* const rgb = photo.rgb.data() + 3 * i;
    if ((i < flaws.size() && (flaws[i] & kUnusable) != 0)) out[i] = 0;
    else if (!std::isfinite(rgb[0]) || !std::isfinite(rgb[1]) || !std::isfinite(rgb[2])) out[i] = 0;
  }
  return out;
}

exposure::Distribution light_above(const image::Picture& photo, std::span<const float> weights, double floor) {
  exposure::Histogram histogram;
  histogram.add(photo, weights, static_cast<float>(floor));
  return exposure::Distribution(histogram.luminance());
}

}  // namespace

std::optional<Exposures> exposures_of(const image::Picture& photo, std::span<const std::uint8_t> flaws, double noise) {
  const std::vector<float> weights = weights_of(photo, flaws);
  exposure::Distribution light = light_above(photo, weights, noise);
  if (light.is_empty()) light = light_above(photo, weights, 0);
  if (light.is_empty()) return std::nullopt;
  return Exposures{tenths(exposure::ev_for(light.percentile(kShare), exposure::white_zone())),
                   tenths(std::log2(brdf::Zones::kMiddleGrey) - light.mean_log2())};
}

}  // namespace likeness::olat_pair
