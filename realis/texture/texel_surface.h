#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "realis/texture/unwrap.h"
#include "render/world/world.h"

namespace likeness::realis {

// The mesh at its texels, in the world.
struct TexelSurface {
  std::vector<glm::vec3> positions;  // [m]
  std::vector<glm::vec3> geometric;  // unit, on the front
  std::vector<glm::vec3> normals;    // unit, of shading: with normal maps
};
TexelSurface surface_of(const world::World& world, scene::Index instance, const Unwrapped& unwrapped);

// f(texel, point) for each texel, its front as seen along its normal; from many threads at once.
void over_texels(const world::World& world, scene::Index instance, const Unwrapped& unwrapped,
                 const std::function<void(std::size_t, const surface::Point&)>& f);

// How a texel's place in the world moves with the texture: from one texel to the next one to the right, and down [m]. Of a
// triangle; zero where its texture coordinates span no area.
struct TexelStep {
  glm::dvec3 right{0}, down{0};
};
TexelStep step_of(const world::World& world, scene::Index instance, std::uint32_t triangle, int size);

}  // namespace likeness::realis
