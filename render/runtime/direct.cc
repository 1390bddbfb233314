#include <array>

#include <glm/geometric.hpp>

#include "render/ray/offset.h"
#include "render/runtime/pass.h"
#include "render/sampling/heuristic.h"
#include "render/sampling/sobol.h"

namespace likeness::runtime {
namespace {

bool has_area(const scene::Scene& scene, std::size_t light) {
  return light >= scene.lights.size() || light::has_area(scene.lights[light]);  // surfaces that shine follow the lights
}

// Light that arrives at points of a tile unless it is hidden: up to two directions a point, traced together.
struct ShadowRays {
  std::array<ray::Ray, 2 * kTilePixels> rays;
  std::array<glm::vec3, 2 * kTilePixels> gains;
  std::array<std::size_t, 2 * kTilePixels> whose;
  std::array<std::uint8_t, 2 * kTilePixels> is_occluded;
  std::size_t count = 0;

  void add(std::size_t who, const surface::Point& point, const glm::vec3& direction, float distance,
           const glm::vec3& gain) {
    if (!(gain.r > 0 || gain.g > 0 || gain.b > 0)) return;
    const float far = distance == ray::kFar ? ray::kFar : distance * (1 - 1e-4f);
    rays[count] = {ray::beside(point.position, point.normal), 0, direction, far};
    gains[count] = gain, whose[count++] = who;
  }
  void trace(const ray::Tracer& tracer, std::array<glm::vec3, kTilePixels>& sums) {
    tracer.occluded(std::span(rays).first(count), std::span(is_occluded).first(count));
    for (std::size_t i = 0; i < count; ++i)
      if (is_occluded[i] == 0) sums[whose[i]] += gains[i];
  }
};

// A direction that the light chooses.
void add_light_sample(const Context& c, ShadowRays& shadows, std::size_t who, const surface::Point& point,
                      std::size_t index, const glm::vec2& u, float share) {
  const light::Sample sample = c.world.lights.sample_light(index, point.position, u);
  if (!sample.is_some()) return;
  // Surfaces that shine are not found by directions of a surface's own here.
  const bool is_shared = sample.pdf > 0 && index < c.world.scene.lights.size();
  surface::Value f;
  if (is_shared) f = point.eval(sample.to_light);
  else f.f_cos = point.f_cos(sample.to_light);
  shadows.add(who, point, sample.to_light, sample.distance,
              f.f_cos * sample.value * (share * (is_shared ? sampling::power_heuristic(sample.pdf, f.pdf) : 1.0f)));
}

// A direction that the surface chooses, if it meets the light: what makes highlights smooth.
void add_own_sample(const Context& c, ShadowRays& shadows, std::size_t who, const surface::Point& point,
                    std::size_t index, float choice, const glm::vec2& u, float share) {
  if (index >= c.world.scene.lights.size() || !c.world.scene.lights[index].is_visible) return;
  const surface::Direction own = point.sample(choice, u);
  if (!(own.pdf > 0)) return;
  const light::Sample met = c.world.lights.meet(index, point.position, own.to_light);
  if (!met.is_some()) return;
  shadows.add(who, point, own.to_light, met.distance,
              own.weight * met.value * (share * sampling::power_heuristic(own.pdf, met.pdf)));
}

void light(Context& c, const Tile& tile) {
  std::array<surface::Point, kTilePixels> points;
  std::array<std::size_t, kTilePixels> pixels;
  std::array<glm::vec3, kTilePixels> sums;
  std::size_t count = 0;
  for (int y = tile.y; y < tile.y + tile.height; ++y)
    for (int x = tile.x; x < tile.x + tile.width; ++x) {
      const std::size_t pixel = c.frame.pixel(x, y);
      if (!c.frame.cells[pixel].is_surface()) continue;
      restore(c, pixel, points[count]);
      sums[count] = glm::vec3(0);
      pixels[count++] = pixel;
    }

  ShadowRays shadows;
  for (std::uint32_t k = 0; k < tile.lights; ++k) {
    const std::size_t index = c.frame.lights[tile.first_light + k];
    const bool is_wide = has_area(c.world.scene, index);
    const int samples = is_wide ? c.settings.light_samples : 1;
    for (int s = 0; s < samples; ++s) {
      shadows.count = 0;
      for (std::size_t i = 0; i < count; ++i) {
        if (!is_wide) {
          add_light_sample(c, shadows, i, points[i], index, glm::vec2(0.5f), 1);
          continue;
        }
        const auto number = c.sample * static_cast<std::uint32_t>(samples) + static_cast<std::uint32_t>(s);
        sampling::Samples numbers(static_cast<std::uint32_t>(pixels[i]), number,
                                  c.settings.seed + 1 + static_cast<std::uint32_t>(index));
        const float share = 1 / static_cast<float>(samples);
        add_light_sample(c, shadows, i, points[i], index, numbers.next(), share);
        add_own_sample(c, shadows, i, points[i], index, numbers.next_plain(), numbers.next(), share);
      }
      shadows.trace(c.world.tracer, sums);
    }
  }
  const float weight = 1 / static_cast<float>(c.settings.pixel_samples);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t channel = 0; channel < 3; ++channel)
      c.frame.radiance.rgb[3 * pixels[i] + channel] += weight * sums[i][static_cast<int>(channel)];
}

}  // namespace

Pass direct_pass(const plan::Plan& plan) {
  Pass pass{"direct",
            "each light of a tile's list, with traced shadows",
            {Buffer::kSurfaces, Buffer::kTiles, Buffer::kLightLists},
            {Buffer::kRadiance},
            [](Context& c) { for_tiles(c.frame, true, [&](Tile& tile) { light(c, tile); }); }};
  if (has_textures(plan)) pass.reads.push_back(Buffer::kParameters);
  return pass;
}

}  // namespace likeness::runtime
