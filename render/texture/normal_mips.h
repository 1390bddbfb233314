#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "render/scene/scene.h"

namespace likeness::texture {

// One level of a normal map and of the roughness that belongs to it.
struct NormalMip {
  int width = 0, height = 0;
  std::vector<glm::vec3> normals;  // unit, tangent frame, row by row from the top
  std::vector<float> roughness;    // [0, 1]
  // Of the mean of what the texel stands for, [0, 1]: below 2/3 its normals differ by more than roughness 1 says.
  std::vector<float> lengths;
};

// Roughness below a normal map: a texture, or the same everywhere.
struct RoughnessBelow {
  const scene::Image* image = nullptr;
  scene::Texture texture;
  float everywhere = 0.5f;
};

// All levels down to one texel, or `levels` of them; the first is what is given. Each level halves both sides (rounded
// down, at least 1), by the share of the area that a texel covers: an odd side loses no row. What normals lose in length
// when they are averaged becomes roughness (brdf/normal_length.h), so that a surface looks as rough from afar as its bumps
// make it.
// Source  Chan, "Material Advances in Call of Duty: WWII", SIGGRAPH 2018 Advances.
std::vector<NormalMip> normal_mips(const scene::Image& normals, const scene::Texture& texture,
                                   const RoughnessBelow& roughness, int levels = 32);

}  // namespace likeness::texture
