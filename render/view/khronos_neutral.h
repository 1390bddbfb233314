#pragma once

#include <algorithm>
#include <array>

namespace likeness::view {

// The Khronos PBR Neutral tonemapper: colors as a material's texture states them, up to a knee; beyond it light is
// compressed towards 1 and loses its color.
//
//     f = x - x^2 / (4 F)                 x = min(r, g, b) <= 2 F, else f = F       the sheen of a dielectric, taken off
//     p = max(r, g, b) - f,   q = 1 - (1 - K)^2 / (p + 1 - 2 K)
//     c' = c - f                                    p <= K
//        = (c - f) q / p g + q (1 - g)              beyond,  g = 1 / (D (p - q) + 1)
//
// c        linear Rec. 709, taken as 0 where it is negative or NaN, and as 1e30 beyond; c' is linear, in [0, 1]
// Source   Khronos Group, "Khronos PBR Neutral Tone Mapper" (2024), section Specification: F = 0.04, K = 0.76, D = 0.15.
struct KhronosNeutral {
  static constexpr float kSheen = 0.04f, kKnee = 0.8f - kSheen, kFading = 0.15f;

  static std::array<float, 3> eval(std::array<float, 3> c) {
    for (float& v : c) v = v > 0 ? std::min(v, 1e30f) : 0;  // NaN is 0
    const float x = std::min({c[0], c[1], c[2]});
    const float sheen = x <= 2 * kSheen ? x - x * x / (4 * kSheen) : kSheen;
    for (float& v : c) v -= sheen;
    const float peak = std::max({c[0], c[1], c[2]});
    if (peak <= kKnee) return c;
    const float low = 1 - (1 - kKnee) * (1 - kKnee) / (peak + 1 - 2 * kKnee);
    const float kept = 1 / (kFading * (peak - low) + 1);
    for (float& v : c) v = v * (low / peak) * kept + low * (1 - kept);
    return c;
  }
};

}  // namespace likeness::view
