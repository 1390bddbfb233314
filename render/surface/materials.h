#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/scene/scene.h"
#include "render/surface/kernel.h"

namespace likeness::surface {

inline constexpr std::size_t kNoPlace = ~std::size_t{0};

// A material with its kernel chosen and its model in floats.
struct Prepared {
  // A parameter that a texture gives: where its floats lie in the model.
  struct Slot {
    const scene::Image* image;
    scene::Texture texture;
    std::size_t at;  // in floats
    int channels;
    float low, high;  // what it is clamped to

    void put(std::size_t channel, float x, ModelBytes& to) const {
      const float clamped = std::isnan(x) ? low : std::clamp(x, low, high);
      std::memcpy(to.bytes.data() + (at + channel) * sizeof x, &clamped, sizeof x);
    }
  };

  const scene::Material* material = nullptr;
  Kernel kernel,
      distant_kernel;  // the latter for Bound::bumps; the same where the material has no diffuse of Callisto's
  // With a bake those two are residual_kernel(), and these are the model's.
  Kernel plain_kernel, plain_distant_kernel;
  const baked::Residual* bake = nullptr;
  unsigned callisto_parts = 0;  // that the kernel has; 0 for other models
  std::size_t model_bytes = 0;
  ModelBytes model;
  std::vector<Slot> slots;
  // Where the roughness of its (first) specular lobe lies in the model, and the second's over it if there is one [floats].
  std::size_t roughness_at = kNoPlace, second_scale_at = kNoPlace;
  std::size_t base_color_at = kNoPlace;  // of the model's base_color, three floats
  std::vector<std::uint16_t>
      varying;  // places of what may differ from point to point: slots, and roughness under bumps
  const scene::Image *normal_map = nullptr, *diffuse_normal_map = nullptr, *emission_map = nullptr;
  bool emits = false, is_callisto = false;

  bool has_dual_normals() const { return diffuse_normal_map != nullptr; }
  bool has_textures() const {
    return !slots.empty() || normal_map != nullptr || diffuse_normal_map != nullptr || bake != nullptr;
  }

  // The parameters at a place: the model itself, or a copy of it in `scratch` with what the textures say.
  const void* model_at(const glm::vec2& uv, ModelBytes& scratch) const;
  // The same by what `read(slot, is_number)` says of each: a number if is_number() holds, otherwise a color.
  template <class Read>
  const void* model_with(ModelBytes& scratch, Read&& read) const {
    if (slots.empty()) return &model;
    std::memcpy(&scratch, &model, model_bytes);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      if (slots[i].channels == 1) slots[i].put(0, read(i, std::true_type{}), scratch);
      else {
        const glm::vec3 c = read(i, std::false_type{});
        for (int k = 0; k < 3; ++k) slots[i].put(static_cast<std::size_t>(k), c[k], scratch);
      }
    }
    return &scratch;
  }
};

// All materials of a scene. `force_all` chooses the kernels that have every part.
std::vector<Prepared> prepare_materials(const scene::Scene& scene, bool force_all = false);

}  // namespace likeness::surface
