#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "render/light/environment.h"
#include "render/world/world.h"

namespace likeness::runtime {

// What baked residuals return of an environment, without shadows: of each lobe, as an instance turns it, the integral of the
// radiance over it, and where that light comes from in the mean. A texel then costs eight look-ups.
//
//     integral of G_k L max(n . w, floor)  ~  (integral of G_k L) max(n . m_k, floor) a_k,   m_k = mean of w over G_k L
//
// a_k is the share of the lobe's light above the surface, as if it were spread evenly over its width about m_k. Exact for
// lobes of which all light arrives above the surface and above the floor, or below the floor; docs/realis.md has the error.
class ResidualMaps {
 public:
  ResidualMaps() = default;
  ResidualMaps(const light::Environment& environment, const world::World& world);

  // Of a point with a bake, of the instance that it is on: may be negative [W/(m^2 sr)].
  glm::vec3 light(const surface::Point& point, scene::Index instance) const;

 private:
  struct Lobe {
    glm::vec3 light{0, 0, 0};  // of G = 1 everywhere the environment's integral [W/m^2]
    glm::vec3 from{0, 0, 0};   // mean direction, world; shorter than 1 by how far it is spread
    float width = 0;           // sine of that spread
  };
  std::vector<std::vector<Lobe>> tables_;
  std::vector<std::size_t> table_of_;  // of each instance, in tables_
};

}  // namespace likeness::runtime
