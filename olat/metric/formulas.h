#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/image/cie_lab.h"
#include "render/image/color_difference.h"

// What the metrics compute of one channel, or one color, of a pair. The viewer's shader follows these lines one by one
// (float there as here), so they have no branch that it has not. Photo and render are finite.
//
// Sign        positive: the photo is brighter than the render.
// Noise       `noise` is the standard deviation of the photo's noise about black, in the unit of its light; at least
//             kLeastNoise.
namespace likeness::metric {

inline constexpr float kLeastNoise = std::numeric_limits<float>::min();  // 2^-126: black over black stays a number

// Light is not negative: what is below 0 is noise about black (or a wrong black level) and counts as black, so that the
// logarithm exists. This is the clamp of `stops`; no other metric has one.
inline float lit(float light) { return std::max(light, 0.0f); }

// log2((photo + n) / (render + n)) [stop]. As a difference of logarithms, since the quotient of two floats may overflow.
// Where both are far above the noise it is the exposure that is missing; where both are noise it goes to 0.
inline float stops(float photo, float render, float noise) {
  return std::log2(lit(photo) + noise) - std::log2(lit(render) + noise);
}

inline float signed_difference(float photo, float render) { return photo - render; }

inline float absolute_difference(float photo, float render) { return std::abs(photo - render); }

// 2 |photo - render| / (|photo| + |render| + 2 n), in [0, 2): 0 equal, 2 where one is black or they differ in sign.
inline float smape(float photo, float render, float noise) {
  return 2 * std::abs(photo - render) / (std::abs(photo) + std::abs(render) + 2 * noise);
}

using image::delta_e_2000;

}  // namespace likeness::metric
