#include "realis/texture/property_maps.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/geometric.hpp>

#include "render/baked/surface_maps.h"
#include "render/image/write.h"
#include "render/surface/residual.h"

namespace likeness::realis {

void write_property_maps(const world::World& world, scene::Index instance, const Unwrapped& unwrapped,
                         const std::filesystem::path& folder) {
  const surface::Prepared& material = world.materials[world.scene.instances[instance].material];
  const glm::mat3 model_from_world =
      surface::model_from_world(glm::mat3(world.scene.instances[instance].world_from_object));
  baked::Surface out;
  out.normals = image::Picture(unwrapped.size, unwrapped.size);
  out.base_colors = image::Picture(unwrapped.size, unwrapped.size);
  image::DisplayPicture roughness(unwrapped.size, unwrapped.size);
  const bool has_roughness = material.roughness_at != surface::kNoPlace;
  over_texels(world, instance, unwrapped, [&](std::size_t t, const surface::Point& point) {
    const std::size_t pixel = unwrapped.pixels[t];
    const glm::vec3 normal = glm::normalize(model_from_world * point.shading_normal);
    const glm::vec3 color = material.kernel.base_color(point.bound);
    float rough = 0;
    if (has_roughness)
      std::memcpy(&rough, static_cast<const char*>(point.bound.model) + material.roughness_at * sizeof rough,
                  sizeof rough);
    for (std::size_t c = 0; c < 3; ++c) {
      out.normals.rgb[3 * pixel + c] = normal[static_cast<int>(c)];
      out.base_colors.rgb[3 * pixel + c] = std::max(color[static_cast<int>(c)], 0.0f);
      roughness.rgb[3 * pixel + c] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(rough, 0.0f, 1.0f)));
    }
  });
  if (const auto* callisto = std::get_if<brdf::Callisto<double>>(&material.material->brdf)) out.material = *callisto;
  std::filesystem::create_directories(folder);
  std::filesystem::remove(folder / "roughness.png");
  if (has_roughness) image::write_png(folder / "roughness.png", roughness);
  baked::write_surface(folder, out);
}

}  // namespace likeness::realis
