#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <glm/vec3.hpp>

namespace likeness::realis::test {

// Directions spread evenly over the half sphere about z (Fibonacci's spiral).
inline std::vector<glm::dvec3> dome(std::size_t count) {
  std::vector<glm::dvec3> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (static_cast<double>(i) + 0.5) / static_cast<double>(count), r = std::sqrt(1 - z * z);
    const double phi = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
    out.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
  }
  return out;
}

}  // namespace likeness::realis::test
