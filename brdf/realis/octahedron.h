#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "brdf/vector.h"

// Functions of the direction as a table over the octahedron that is unfolded to a square: places are whole at its corners
// and along its edges, so that a table is continuous over the whole sphere.
//
// Source  Engelhardt and Dachsbacher 2008, "Octahedron Environment Maps".
namespace likeness::brdf {

// side x side places; side odd, >= 3, so that no cell is on both sides of an axis.
struct Octahedron {
  int side = 3;

  std::size_t count() const { return static_cast<std::size_t>(side) * static_cast<std::size_t>(side); }

  // The direction of place (x, y), unit.
  Vec3<float> direction(int x, int y) const {
    const float step = 2 / static_cast<float>(side - 1);
    const float u = static_cast<float>(x) * step - 1, v = static_cast<float>(y) * step - 1;
    const float z = 1 - std::abs(u) - std::abs(v), fold = std::max(-z, 0.0f);
    const Vec3<float> d(u - std::copysign(fold, u), v - std::copysign(fold, v), z);
    return d * (1 / std::sqrt(dot(d, d)));
  }

  // Three places about a direction (any length but 0), and their shares, which sum to 1: a corner each of a triangle whose
  // long side lies along the folds of the square, so that no triangle is bent. NaN and 0: those of +z.
  struct Three {
    std::array<std::size_t, 3> places;
    std::array<float, 3> shares;
  };
  Three about(const Vec3<float>& direction) const {
    const float length = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
    float u = 0, v = 0;
    if (length > 0 && length < HUGE_VALF) {
      u = direction.x / length, v = direction.y / length;
      if (direction.z < 0) {
        const float up = 1 - std::abs(v), right = 1 - std::abs(u);
        u = std::copysign(up, u), v = std::copysign(right, v);
      }
    }
    const auto last = static_cast<float>(side - 1);
    const float x = std::clamp((u + 1) * 0.5f * last, 0.0f, last), y = std::clamp((v + 1) * 0.5f * last, 0.0f, last);
    const int i = std::min(static_cast<int>(x), side - 2), j = std::min(static_cast<int>(y), side - 2);
    const auto width = static_cast<std::size_t>(side);
    const std::size_t at = static_cast<std::size_t>(j) * width + static_cast<std::size_t>(i), right = at + 1,
                      below = at + width, across = below + 1;
    const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
    const bool falls = (2 * i + 1 < side - 1) == (2 * j + 1 < side - 1);  // folds of this quarter: x + y is the same
    if (falls && a + b <= 1) return {{at, right, below}, {1 - a - b, a, b}};
    if (falls) return {{across, below, right}, {a + b - 1, 1 - a, 1 - b}};
    if (a >= b) return {{at, right, across}, {1 - a, a - b, b}};
    return {{at, below, across}, {1 - b, b - a, a}};
  }
};

}  // namespace likeness::brdf
