#include <algorithm>
#include <array>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "brdf/proxima.h"
#include "render/ray/offset.h"
#include "render/runtime/pass.h"
#include "render/sampling/heuristic.h"
#include "render/sampling/sobol.h"

namespace likeness::runtime {
namespace {

using C = brdf::Callisto<float>;

// Directions of the surface's own and of the picture's in turn, weighted against each other, as the path tracer does.
glm::vec3 by_rays(const Context& c, const surface::Point& point, std::size_t pixel, int rays) {
  const light::Environment& environment = *c.world.lights.environment();
  const bool chooses = environment.has_picture();
  const glm::vec3 origin = ray::beside(point.position, point.normal);
  const auto is_open = [&](const glm::vec3& direction) {
    return !c.world.tracer.occluded({origin, 0, direction, ray::kFar});
  };
  glm::vec3 sum(0);
  for (int r = 0; r < rays; ++r) {
    sampling::Samples samples(static_cast<std::uint32_t>(pixel),
                              c.sample * static_cast<std::uint32_t>(rays) + static_cast<std::uint32_t>(r),
                              c.settings.seed + 0x51ed270bu);
    const float choice = samples.next_plain();
    const surface::Direction own = point.sample(choice, samples.next());
    if (own.pdf > 0) {
      const float w = chooses ? sampling::power_heuristic(own.pdf, environment.pdf(own.to_light)) : 1.0f;
      const glm::vec3 gain = own.weight * environment.radiance(own.to_light) * w;
      if ((gain.r > 0 || gain.g > 0 || gain.b > 0) && is_open(own.to_light)) sum += gain;
    }
    if (!chooses) continue;
    const auto chosen = environment.sample(samples.next());
    if (!(chosen.pdf > 0)) continue;
    const surface::Value f = point.eval(chosen.direction);
    const glm::vec3 gain =
        f.f_cos * environment.radiance(chosen.direction) * (sampling::power_heuristic(chosen.pdf, f.pdf) / chosen.pdf);
    if ((gain.r > 0 || gain.g > 0 || gain.b > 0) && is_open(chosen.direction)) sum += gain;
  }
  return sum / static_cast<float>(rays);
}

// Callisto by the maps: its diffuse as Lambert's (or Proxima's over bumps, as if light and view were less than 90 degrees
// apart, where it is linear in the light's cosine), its lobes with Schlick's Fresnel, neither shaped nor shaded.
glm::vec3 by_maps(const Context& c, const surface::Point& point, std::size_t pixel) {
  const C& m = *static_cast<const C*>(point.bound.model);
  const glm::vec3 rho(m.base_color.r, m.base_color.g, m.base_color.b);
  const glm::vec3 f0 = glm::mix(glm::vec3(0.08f * m.specular), rho, m.metallic);
  const glm::vec3 normal = point.frame.world(point.bound.specular_normal);
  const glm::vec3 diffuse_normal = point.frame.world(point.bound.diffuse_normal);
  const glm::vec3 to_view = point.frame.world(point.to_view);
  const float cos_o = std::clamp(glm::dot(normal, to_view), 0.0f, 1.0f);
  const glm::vec3 mirror = 2 * glm::dot(normal, to_view) * normal - to_view;
  // A mapped normal may mirror the view into the surface itself, from where no light comes.
  const float above = std::clamp(1 + glm::dot(mirror, point.normal), 0.0f, 1.0f);
  const auto lobe = [&](float roughness) {
    const glm::vec2 r = EnvironmentMaps::reflectance(cos_o, roughness);
    return (f0 * r.x + r.y) * (above * above) * c.maps.radiance(mirror, roughness);
  };
  glm::vec3 specular = lobe(m.roughness);
  if (m.dual_specular_opacity > 0)
    specular = glm::mix(specular, lobe(std::min(m.roughness * m.dual_specular_roughness_scale, 1.0f)),
                        m.dual_specular_opacity);
  glm::vec3 diffuse = c.maps.irradiance(diffuse_normal);
  if (const float bumps = point.bound.bumps; bumps > 0) {
    const float even = brdf::proxima_factor_cos(bumps, 0.0f, 1.0f),
                cosine = brdf::proxima_factor_cos(bumps, 1.0f, 1.0f) - even;
    diffuse = cosine * diffuse + even * c.maps.hemisphere(diffuse_normal);
  }
  const glm::vec3 light = rho * ((1 - m.metallic) * 0.31830989f) * diffuse + specular;
  if (point.bound.residual == nullptr) return light;
  return glm::max(light + c.residuals.light(point, c.frame.hits[pixel].instance), glm::vec3(0));
}

constexpr int rays_of(EnvironmentLevel level) {
  return level == EnvironmentLevel::kMaps ? 16 : 1 << (2 * (static_cast<int>(level) - 1));
}

}  // namespace

Pass environment_pass(const plan::Plan& plan, const Settings& settings) {
  const bool has_maps = settings.environment == EnvironmentLevel::kMaps;
  const int rays = rays_of(settings.environment);
  Pass pass{"environment",
            has_maps
                ? "light of the environment by harmonics and filtered pictures (other models than Callisto: 16 rays)"
                : "light of the environment by rays",
            {Buffer::kSurfaces, Buffer::kTiles},
            {Buffer::kRadiance},
            [=](Context& c) {
              if (!c.world.lights.environment()) return;  // every effect is forced, and there is none
              for_tiles(c.frame, true, [&](Tile& tile) {
                surface::Point point;
                for (int y = tile.y; y < tile.y + tile.height; ++y)
                  for (int x = tile.x; x < tile.x + tile.width; ++x) {
                    const std::size_t pixel = c.frame.pixel(x, y);
                    if (!c.frame.cells[pixel].is_surface()) continue;
                    restore(c, pixel, point);
                    const bool is_callisto = point.material->is_callisto;
                    const glm::vec3 light =
                        has_maps && is_callisto ? by_maps(c, point, pixel) : by_rays(c, point, pixel, rays);
                    for (std::size_t k = 0; k < 3; ++k)
                      c.frame.radiance.rgb[3 * pixel + k] +=
                          light[static_cast<int>(k)] / static_cast<float>(c.settings.pixel_samples);
                  }
              });
            }};
  if (has_textures(plan)) pass.reads.push_back(Buffer::kParameters);
  return pass;
}

}  // namespace likeness::runtime
