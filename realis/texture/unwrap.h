#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "render/scene/scene.h"

namespace likeness::realis {

inline constexpr int kMostResolution = 8192;  // texels a side

// Which texels of a square texture a mesh uses, and the point of the mesh that each stands for: that under its middle, or,
// for texels whose middle no triangle covers but which lie at most kGutter beside one, the nearest point of the mesh in the
// texture. So a bilinear look-up anywhere on the mesh, seams included, meets texels that were baked from the mesh itself.
inline constexpr double kGutter = 2;  // [texel], from the middle

struct Unwrapped {
  int size = 0;                          // texels a side
  std::vector<std::uint32_t> pixels;     // of each texel, in the texture; rising
  std::vector<std::uint32_t> triangles;  // of the mesh
  std::vector<glm::vec2> corners;        // weights of the triangle's second and third corner
  std::size_t inside = 0;                // texels whose middle a triangle covers
  std::size_t overlapping = 0;           // of those, by more than one; the first in the mesh has it
};

// Texture coordinates are rounded to 1/256 of a texel, and a middle on an edge that two triangles share belongs to one of
// them. `name` is the object's, for messages. Throws files::UsageError: no triangles or texture coordinates, coordinates
// outside [0, 1] by more than a texel, more than one texel in 200 that two triangles share.
Unwrapped unwrap(const scene::Mesh& mesh, int size, const std::string& name);

}  // namespace likeness::realis
