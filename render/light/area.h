#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/scene/scene.h"

// Directions towards lights that have a size, and their densities over solid angle as seen from a point.
namespace likeness::light {

struct Towards {
  glm::vec3 direction{0, 0, 1};  // unit
  float distance = 0;
  float pdf = 0;  // [1/sr]; 0: the light cannot be seen from there
};

// By solid angle; from far away, where that loses its digits in float, by area. 0 from behind.
// Source  Urena, Fajardo and King 2013, "An Area-Preserving Parametrization for Spherical Rectangles".
Towards sample_rectangle(const scene::RectangleLight& light, const glm::vec3& point, const glm::vec2& u);
float rectangle_pdf(const scene::RectangleLight& light, const glm::vec3& point, const glm::vec3& direction,
                    float distance);

// By area.
Towards sample_disk(const scene::DiskLight& light, const glm::vec3& point, const glm::vec2& u);
float disk_pdf(const scene::DiskLight& light, const glm::vec3& point, const glm::vec3& direction, float distance);

// By solid angle, the cone that the sphere fills; 0 from inside.
Towards sample_sphere(const scene::SphereLight& light, const glm::vec3& point, const glm::vec2& u);
float sphere_pdf(const scene::SphereLight& light, const glm::vec3& point);

}  // namespace likeness::light
