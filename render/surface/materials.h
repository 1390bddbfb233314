#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>

#include "render/scene/scene.h"
#include "render/surface/kernel.h"

namespace likeness::surface {

// A material with its kernel chosen and its model in floats.
struct Prepared {
  // A parameter that a texture gives: where its floats lie in the model.
  struct Slot {
    const scene::Image* image;
    scene::Texture texture;
    std::size_t at;  // in floats
    int channels;
    float low, high;  // what it is clamped to
  };

  const scene::Material* material = nullptr;
  Kernel kernel;
  unsigned callisto_parts = 0;  // that the kernel has; 0 for other models
  std::size_t model_bytes = 0;
  ModelBytes model;
  std::vector<Slot> slots;
  const scene::Image *normal_map = nullptr, *diffuse_normal_map = nullptr, *emission_map = nullptr;
  bool emits = false, is_callisto = false;

  bool has_dual_normals() const { return diffuse_normal_map != nullptr; }
  bool has_textures() const { return !slots.empty() || normal_map != nullptr || diffuse_normal_map != nullptr; }

  // The parameters at a place: the model itself, or a copy of it in `scratch` with what the textures say.
  const void* model_at(const glm::vec2& uv, ModelBytes& scratch) const;
};

// All materials of a scene. `force_all` chooses the kernels that have every part.
std::vector<Prepared> prepare_materials(const scene::Scene& scene, bool force_all = false);

}  // namespace likeness::surface
