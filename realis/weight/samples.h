#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

// What weights are made from, and what they are.
namespace likeness::realis::weight {

using Color = std::array<float, 3>;

// A subject as a bake sees it: samples are texels under lights, texel by texel, in each the lights. Empty spans are not known,
// and the weights that need them are 1.
struct Samples {
  int width = 0, height = 0;                 // [pixel] of the picture
  std::span<const std::uint32_t> pixels;     // of each texel, in the picture; rising
  std::span<const glm::dvec3> to_lights;     // of each light, unit
  std::span<const double> irradiance;        // of each light; empty: 1
  std::span<const Color> photo, render;      // of each sample, linear; may be negative or not finite
  std::span<const Color> crossed;            // the photo without what shines at the surface; NaN: not known
  std::span<const float> cosine;             // of each sample: light and normal
  std::span<const glm::dvec3> normals;       // of each texel, unit; (0, 0, 0): not known
  std::span<const glm::dvec3> to_views;      // of each texel, unit, from the surface to the camera
  std::span<const std::array<float, 2>> uv;  // of each texel, texture space; NaN: none

  std::size_t texels() const { return pixels.size(); }
  std::size_t lights() const { return to_lights.size(); }
  std::size_t samples() const { return texels() * lights(); }
  double irradiance_of(std::size_t light) const { return irradiance.empty() ? 1 : irradiance[light]; }
};

// Of each sample, in [0, 1]: 1 is trusted, 0 is not looked at.
using Weights = std::vector<float>;

inline double luminance(const Color& c) {
  return 0.2126 * static_cast<double>(c[0]) + 0.7152 * static_cast<double>(c[1]) + 0.0722 * static_cast<double>(c[2]);
}

// The value below which `share` of the numbers are; 0 of none. Reorders them.
inline double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace likeness::realis::weight
