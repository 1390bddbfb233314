#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "render/image/picture.h"

// Pictures whose light the tests know.
namespace likeness::exposure::test {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kDenormal = 1e-40f;

// One row, each grey a pixel.
image::Picture greys(const std::vector<float>& light);

// Colored light whose logarithm is normal, `stops` wide, about middle grey; the same for the same seed.
image::Picture scattered(int width, int height, double stops, std::uint32_t seed);

image::Picture scaled(image::Picture picture, float scale);

}  // namespace likeness::exposure::test
