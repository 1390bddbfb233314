#include "render/image/light_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace likeness::image {
namespace {

void check(const Picture& reference, const Picture& render, Mask mask) {
  const auto size = [](const Picture& p) { return std::to_string(p.width) + " x " + std::to_string(p.height); };
  if (reference.width != render.width || reference.height != render.height)
    throw std::invalid_argument("difference of pictures: reference is " + size(reference) + ", render is " +
                                size(render) + "; both must have the same size");
  if (!mask.empty() && mask.size() != reference.rgb.size() / 3)
    throw std::invalid_argument("difference of pictures: the mask has " + std::to_string(mask.size()) +
                                " values for a picture of " + size(reference));
}

// Calls `use` with the three channels of every pixel that counts, and returns how many did not for their values.
template <class Use>
std::size_t for_pixels(const Picture& reference, const Picture& render, Mask mask, const Use& use) {
  std::size_t not_finite = 0;
  for (std::size_t i = 0; i < reference.rgb.size() / 3; ++i) {
    if (!mask.empty() && mask[i] == 0) continue;
    const float* const g = reference.rgb.data() + 3 * i;
    const float* const r = render.rgb.data() + 3 * i;
    const auto finite = [](const float* p) {
      return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
    };
    if (finite(g) && finite(r)) use(g, r);
    else ++not_finite;
  }
  return not_finite;
}

// The smallest value that a share p of all is at most.
double quantile(std::vector<float>& values, double p) {
  const auto rank = static_cast<std::size_t>(std::ceil(p * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

}  // namespace

RelativeMse relative_mse(const Picture& reference, const Picture& render, double epsilon, Mask mask) {
  check(reference, render, mask);
  if (!(epsilon > 0 && std::isfinite(epsilon)))
    throw std::invalid_argument("relative_mse: epsilon = " + std::to_string(epsilon) + "; it must be above 0");
  RelativeMse out;
  double sum = 0;
  out.not_finite = for_pixels(reference, render, mask, [&](const float* g, const float* r) {
    for (int c = 0; c < 3; ++c) {
      const double truth = static_cast<double>(g[c]), difference = static_cast<double>(r[c]) - truth;
      sum += difference * difference / (truth * truth + epsilon);
    }
    ++out.pixels;
  });
  if (out.pixels > 0) out.value = sum / (3 * static_cast<double>(out.pixels));
  return out;
}

StopsError error_in_stops(const Picture& reference, const Picture& render, double floor_share, Mask mask) {
  check(reference, render, mask);
  if (!(floor_share > 0 && floor_share <= 1))
    throw std::invalid_argument("error_in_stops: floor_share = " + std::to_string(floor_share) +
                                "; it must be in (0, 1]");
  StopsError out;
  double sum = 0;
  out.not_finite = for_pixels(reference, render, mask, [&](const float* g, const float*) {
    for (int c = 0; c < 3; ++c) sum += std::max(0.0, static_cast<double>(g[c]));
    ++out.pixels;
  });
  if (out.pixels == 0) return out;
  // A black reference has no level: any floor above 0 makes black equal to black.
  out.floor = std::max(floor_share * sum / (3 * static_cast<double>(out.pixels)),
                       static_cast<double>(std::numeric_limits<float>::min()));
  std::vector<float> stops;
  stops.reserve(3 * out.pixels);
  for_pixels(reference, render, mask, [&](const float* g, const float* r) {
    for (int c = 0; c < 3; ++c)
      stops.push_back(static_cast<float>(std::abs(
          std::log2(std::max(out.floor, static_cast<double>(r[c])) / std::max(out.floor, static_cast<double>(g[c]))))));
  });
  out.median = quantile(stops, 0.5);
  out.p95 = quantile(stops, 0.95);
  return out;
}

}  // namespace likeness::image
