#include "render/surface/distance.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "brdf/normal_length.h"

namespace likeness::surface {
namespace {

// The deficit of normals that were shortened twice: 1 - (1 - a) (1 - b).
float both(float a, float b) { return a + b - a * b; }

// What roughness becomes when bumps are added.
float roughened(float roughness, float deficit) {
  // One step leaves 2.4e-4 of alpha.
  return std::sqrt(brdf::alpha_of_normal_deficit<1>(both(brdf::normal_deficit(roughness * roughness), deficit)));
}

}  // namespace

SceneLevels::SceneLevels(const std::vector<Prepared>& materials) : first_(materials.data()) {
  std::vector<texture::Levels> made;
  const auto levels_of = [&](const scene::Image& image, const scene::Texture& texture, texture::Meaning meaning,
                             float strength) {
    for (const texture::Levels& other : made)
      if (other.serves(image, texture, meaning, strength)) return other.placed(texture);
    bytes_ += made.emplace_back(image, texture, meaning, strength).bytes();
    return made.back();
  };
  for (const Prepared& material : materials) {
    MaterialLevels& own = materials_.emplace_back();
    for (const Prepared::Slot& slot : material.slots)
      own.slots.push_back(
          levels_of(*slot.image, slot.texture,
                    slot.at == material.roughness_at ? texture::Meaning::kRoughness : texture::Meaning::kValues, 1));
    const auto map = [&](const scene::Image* image, const std::optional<scene::Texture>& texture,
                         texture::Meaning meaning, std::optional<texture::Levels>& out) {
      if (image != nullptr) out = levels_of(*image, *texture, meaning, material.material->normal_strength);
    };
    map(material.normal_map, material.material->normal_map, texture::Meaning::kNormals, own.normal);
    map(material.diffuse_normal_map, material.material->diffuse_normal_map, texture::Meaning::kNormals,
        own.diffuse_normal);
    map(material.emission_map, material.material->emission_map, texture::Meaning::kValues, own.emission);
  }
}

const void* model_over(const Prepared& material, const MaterialLevels& levels, const glm::vec2& uv,
                       const texture::Footprint& footprint, texture::Filter filter, ModelBytes& scratch) {
  return material.model_with(scratch, [&](std::size_t slot, auto is_number) {
    if constexpr (is_number) return levels.slots[slot].number(uv, footprint, filter);
    else return levels.slots[slot].color(uv, footprint, filter);
  });
}

void roughen(const Prepared& material, float deficit, ModelBytes& model) {
  if (!(deficit > 0) || material.roughness_at == kNoPlace) return;
  float* numbers = reinterpret_cast<float*>(model.bytes.data());
  float& roughness = numbers[material.roughness_at];
  // The second lobe's roughness is a multiple of the first's: it takes the same bumps.
  const bool has_second = material.second_scale_at != kNoPlace;
  const float second = has_second ? std::min(roughness * numbers[material.second_scale_at], 1.0f) : 0;
  roughness = roughened(roughness, deficit);
  if (has_second && roughness > 0)
    numbers[material.second_scale_at] = std::max(roughened(second, deficit) / roughness, 1.0f);
}

}  // namespace likeness::surface
