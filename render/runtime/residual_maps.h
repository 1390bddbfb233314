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
//
// Of a bake of mixes the integral itself is kept, mix by mix, for normals on an octahedron: the surface's own normal and the
// shading normal count as one there. The same holds for the soft end of light (baked::Surface::spread); its `least` is of
// single lights, and is left out.
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
  // Of one bake in one turn: its lobes, or of each normal the mixes' light; and the soft end's, over pi.
  struct Table {
    std::vector<Lobe> lobes;
    std::vector<glm::vec3> mixes, soft;
  };
  glm::vec3 of_mixes(const surface::Point& point, const Table& table) const;
  glm::vec3 of_lobes(const surface::Point& point, const Table& table) const;
  std::vector<Table> tables_;
  std::vector<std::size_t> table_of_;  // of each instance, in tables_
};

}  // namespace likeness::runtime
