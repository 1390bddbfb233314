#include "olat/registration/plane.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace likeness::registration {

Plane luminance(const image::Picture& picture) {
  Plane plane(picture.width, picture.height);
  for (std::size_t i = 0; i < plane.values.size(); ++i) {
    const float* const p = picture.rgb.data() + 3 * i;
    const float y = 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
    plane.values[i] = std::isfinite(y) ? y : 0;
  }
  return plane;
}

Plane blurred(const Plane& plane, float sigma) {
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  std::vector<float> taps(static_cast<std::size_t>(2 * radius + 1));
  float sum = 0;
  for (int i = -radius; i <= radius; ++i)
    sum += taps[static_cast<std::size_t>(i + radius)] = std::exp(-0.5f * static_cast<float>(i * i) / (sigma * sigma));
  for (float& tap : taps) tap /= sum;
  Plane rows(plane.width, plane.height), out(plane.width, plane.height);
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      float value = 0;
      for (int i = -radius; i <= radius; ++i)
        value += taps[static_cast<std::size_t>(i + radius)] * plane.at(std::clamp(x + i, 0, plane.width - 1), y);
      rows.at(x, y) = value;
    }
  for (int y = 0; y < plane.height; ++y)
    for (int i = -radius; i <= radius; ++i) {
      const float tap = taps[static_cast<std::size_t>(i + radius)];
      const int from = std::clamp(y + i, 0, plane.height - 1);
      for (int x = 0; x < plane.width; ++x) out.at(x, y) += tap * rows.at(x, from);
    }
  return out;
}

Plane halved(const Plane& plane) {
  Plane out(plane.width / 2, plane.height / 2);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      out.at(x, y) = 0.25f * (plane.at(2 * x, 2 * y) + plane.at(2 * x + 1, 2 * y) + plane.at(2 * x, 2 * y + 1) +
                              plane.at(2 * x + 1, 2 * y + 1));
  return out;
}

double weighted_mean(const Plane& plane, std::span<const float> weight) {
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < plane.values.size(); ++i) {
    const double w = weight.empty() ? 1 : static_cast<double>(weight[i]);
    if (!(w > 0)) continue;
    sum += w * static_cast<double>(plane.values[i]);
    total += w;
  }
  return total > 0 ? sum / total : 0;
}

float quantile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void require_one_size(const image::Picture& photo, const image::Picture& render, std::span<const float> weight) {
  const auto text = [](const image::Picture& p) { return std::to_string(p.width) + " x " + std::to_string(p.height); };
  if (photo.width != render.width || photo.height != render.height)
    throw std::invalid_argument("registration: photo is " + text(photo) + ", render is " + text(render) +
                                "; both must have the same size");
  if (!weight.empty() && weight.size() != photo.rgb.size() / 3)
    throw std::invalid_argument("registration: " + std::to_string(weight.size()) + " weights for a photo of " +
                                text(photo));
}

}  // namespace likeness::registration
