#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/vec3.hpp>

namespace likeness::ray {

// A point beside a surface, on the side that `normal` (unit, geometric) points to, so far away that a ray from there does
// not meet the surface again because of rounding, and no farther: some units in the last place of each coordinate, or a
// fixed small distance where a coordinate is near 0.
// Source  Waechter and Binder 2019, "A Fast and Robust Method for Avoiding Self-Intersection" (Ray Tracing Gems, 6).
inline glm::vec3 beside(const glm::vec3& point, const glm::vec3& normal) {
  constexpr float kNearZero = 1.0f / 32, kSmall = 1.0f / 65536, kUlps = 256;
  const auto moved = [&](float x, float n) {
    if (std::abs(x) < kNearZero) return x + kSmall * n;
    const auto ulps = static_cast<std::int32_t>(kUlps * n);
    return std::bit_cast<float>(std::bit_cast<std::int32_t>(x) + (x < 0 ? -ulps : ulps));
  };
  return {moved(point.x, normal.x), moved(point.y, normal.y), moved(point.z, normal.z)};
}

}  // namespace likeness::ray
