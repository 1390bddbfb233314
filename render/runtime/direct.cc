#include <array>

#include <glm/geometric.hpp>

#include "render/ray/offset.h"
#include "render/runtime/pass.h"
#include "render/sampling/sobol.h"

namespace likeness::runtime {
namespace {

bool has_area(const scene::Scene& scene, std::size_t light) {
  if (light >= scene.lights.size()) return true;
  const scene::LightShape& shape = scene.lights[light].shape;
  return !std::holds_alternative<scene::PointLight>(shape) && !std::holds_alternative<scene::SpotLight>(shape) &&
         !std::holds_alternative<scene::DirectionalLight>(shape);
}

void light(Context& c, const Tile& tile) {
  std::array<surface::Point, kTilePixels> points;
  std::array<std::size_t, kTilePixels> pixels;
  std::array<glm::vec3, kTilePixels> sums;
  std::size_t count = 0;
  const glm::vec3 camera = c.camera.position();
  for (int y = tile.y; y < tile.y + tile.height; ++y)
    for (int x = tile.x; x < tile.x + tile.width; ++x) {
      const std::size_t pixel = c.frame.pixel(x, y);
      if (!c.frame.cells[pixel].is_surface()) continue;
      restore(c, pixel, camera, points[count]);
      sums[count] = glm::vec3(0);
      pixels[count++] = pixel;
    }

  std::array<ray::Ray, kTilePixels> rays;
  std::array<glm::vec3, kTilePixels> gains;
  std::array<std::size_t, kTilePixels> whose;
  std::array<std::uint8_t, kTilePixels> is_occluded;
  for (std::uint32_t k = 0; k < tile.lights; ++k) {
    const std::size_t index = c.frame.lights[tile.first_light + k];
    const int samples = has_area(c.world.scene, index) ? c.settings.light_samples : 1;
    for (int s = 0; s < samples; ++s) {
      std::size_t lit = 0;
      for (std::size_t i = 0; i < count; ++i) {
        glm::vec2 u(0.5f);
        if (samples > 1 || has_area(c.world.scene, index)) {
          const auto number = c.sample * static_cast<std::uint32_t>(samples) + static_cast<std::uint32_t>(s);
          u = sampling::Samples(static_cast<std::uint32_t>(pixels[i]), number,
                                c.settings.seed + 1 + static_cast<std::uint32_t>(index))
                  .next();
        }
        const light::Sample sample = c.world.lights.sample_light(index, points[i].position, u);
        if (!sample.is_some()) continue;
        const glm::vec3 gain = points[i].eval(sample.to_light).f_cos * sample.value;
        if (!(gain.r > 0 || gain.g > 0 || gain.b > 0)) continue;
        const float far = sample.distance == ray::kFar ? ray::kFar : sample.distance * (1 - 1e-4f);
        rays[lit] = {ray::beside(points[i].position, points[i].normal), 0, sample.to_light, far};
        gains[lit] = gain, whose[lit++] = i;
      }
      c.world.tracer.occluded(std::span(rays).first(lit), std::span(is_occluded).first(lit));
      for (std::size_t i = 0; i < lit; ++i)
        if (is_occluded[i] == 0) sums[whose[i]] += gains[i] / static_cast<float>(samples);
    }
  }
  const float weight = 1 / static_cast<float>(c.settings.pixel_samples);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t channel = 0; channel < 3; ++channel)
      c.frame.radiance.rgb[3 * pixels[i] + channel] += weight * sums[i][static_cast<int>(channel)];
}

}  // namespace

Pass direct_pass(const plan::Plan&) {
  return {"direct",
          "each light of a tile's list, with traced shadows",
          {Buffer::kSurfaces, Buffer::kTiles, Buffer::kLightLists},
          {Buffer::kRadiance},
          [](Context& c) { for_tiles(c.frame, true, [&](Tile& tile) { light(c, tile); }); }};
}

}  // namespace likeness::runtime
