#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "render/surface/materials.h"
#include "render/texture/levels.h"

// Surfaces of which a pixel shows more than a texel: textures by their levels, and the bumps of normal maps that are too
// small to be seen as what they do to light, which is roughness.
namespace likeness::surface {

// The levels of a material's textures.
struct MaterialLevels {
  std::vector<texture::Levels> slots;  // of Prepared::slots
  std::optional<texture::Levels> normal, diffuse_normal, emission;
};

// The levels of all textures of a scene; textures that differ only in where they are placed share them.
class SceneLevels {
 public:
  // Keeps the materials, which must outlive it. Takes about a third of a second for sixteen million texels.
  explicit SceneLevels(const std::vector<Prepared>& materials);

  const MaterialLevels& of(const Prepared& material) const {
    return materials_[static_cast<std::size_t>(&material - first_)];
  }
  std::size_t bytes() const { return bytes_; }

 private:
  const Prepared* first_;
  std::vector<MaterialLevels> materials_;
  std::size_t bytes_ = 0;
};

// What a pixel sees of a surface, and how its textures are to be read.
struct Pixel {
  const SceneLevels& levels;
  texture::Filter filter = texture::Filter::kAnisotropic;
  // By how much the unit direction of its ray changes for one pixel to the right, and one down.
  glm::vec3 right{0, 0, 0}, down{0, 0, 0};
};

// The model at a place as model_at has it, in `scratch`, over a footprint.
const void* model_over(const Prepared& material, const MaterialLevels& levels, const glm::vec2& uv,
                       const texture::Footprint& footprint, texture::Filter filter, ModelBytes& scratch);

// Adds bumps to a model's roughness: normals of the microfacets, of a mean length that is short of 1 by `deficit`, about
// normals whose mean is short by that too. Models without a roughness keep what they have.
// Source  Chan, "Material Advances in Call of Duty: WWII", SIGGRAPH 2018 Advances; docs/models/normal_length.md.
void roughen(const Prepared& material, float deficit, ModelBytes& model);

}  // namespace likeness::surface
