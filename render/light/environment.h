#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/sampling/distribution.h"
#include "render/scene/scene.h"

namespace likeness::light {

// Luminance of linear Rec. 709 [unit of c].
inline float brightness(const glm::vec3& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

// The light from infinitely far away. Keeps pointers into the scene.
class Environment {
 public:
  Environment(const scene::Scene& scene, const scene::Environment& environment);

  // Radiance [W/(m^2 sr)] from a direction (unit).
  glm::vec3 radiance(const glm::vec3& direction) const { return has_picture() ? pictured(direction) : scale_; }

  // Whether it is worth choosing directions by: not where it is the same everywhere.
  bool has_picture() const { return image_ != nullptr; }
  glm::vec3 mean_radiance() const { return mean_; }  // over the sphere

  struct Choice {
    glm::vec3 direction{0, 1, 0};
    float pdf = 0;  // [1/sr]
  };
  // In proportion to a smoothed brightness, so that nothing bright is missed. With a picture only.
  Choice sample(const glm::vec2& u) const;
  float pdf(const glm::vec3& direction) const;

  // Where on the picture a direction is, and the other way round: [0, 1)^2, as scene::Environment has it.
  glm::vec2 place_of(const glm::vec3& direction) const;
  glm::vec3 direction_at(const glm::vec2& place) const;

 private:
  glm::vec3 pictured(const glm::vec3& direction) const;

  const scene::Image* image_ = nullptr;
  scene::Transfer transfer_ = scene::Transfer::kLinear;
  glm::vec3 scale_{1, 1, 1}, mean_{0, 0, 0};
  float turn_ = 0;
  sampling::Distribution2 cells_;
};

}  // namespace likeness::light
