#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace likeness::ray {

// Right-handed axes around a unit vector, without a jump but at z = 0 of the world.
// Source  Duff et al. 2017, "Building an Orthonormal Basis, Revisited" (JCGT 6(1)).
struct Frame {
  glm::vec3 x, y, z;

  Frame() : x(1, 0, 0), y(0, 1, 0), z(0, 0, 1) {}
  explicit Frame(const glm::vec3& n) : z(n) {
    const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    x = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    y = {b, sign + n.y * n.y * a, -n.y};
  }
  Frame(const glm::vec3& x_, const glm::vec3& y_, const glm::vec3& z_) : x(x_), y(y_), z(z_) {}

  glm::vec3 local(const glm::vec3& w) const { return {glm::dot(w, x), glm::dot(w, y), glm::dot(w, z)}; }
  glm::vec3 world(const glm::vec3& w) const { return w.x * x + w.y * y + w.z * z; }
};

}  // namespace likeness::ray
