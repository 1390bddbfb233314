#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "render/ray/offset.h"
#include "render/runtime/pass.h"
#include "render/sampling/sobol.h"

namespace likeness::runtime {
namespace {

constexpr int kMostLightsPassed = 64;

void show(Context& c, Tile& tile, bool has_textures) {
  const world::World& world = c.world;
  const std::size_t instances = world.scene.instances.size();
  std::array<ray::Ray, kTilePixels> rays;
  std::array<ray::Hit, kTilePixels> hits;
  std::size_t count = 0;
  for (int y = tile.y; y < tile.y + tile.height; ++y)
    for (int x = tile.x; x < tile.x + tile.width; ++x) rays[count++] = camera_ray(c, x, y);
  world.tracer.closest(std::span(rays).first(count), std::span(hits).first(count));

  surface::Point point;
  tile.surfaces = 0;
  tile.low = glm::vec3(ray::kFar), tile.high = glm::vec3(-ray::kFar);
  glm::vec3 normals(0);
  std::array<glm::vec3, kTilePixels> kept;
  std::size_t i = 0;
  for (int y = tile.y; y < tile.y + tile.height; ++y)
    for (int x = tile.x; x < tile.x + tile.width; ++x, ++i) {
      const std::size_t pixel = c.frame.pixel(x, y);
      const ray::Ray& ray = rays[i];
      ray::Hit& hit = hits[i];
      glm::vec3 radiance(0);
      if (hit.is_some() && hit.surface >= instances) {
        // Lights hide nothing: the surface behind them is looked for from the start, as the path tracer does.
        const ray::Hit behind = world.tracer.closest(ray, ray::Seen::kSurfaces);
        ray::Ray rest = ray;
        rest.far = behind.distance;
        for (int passed = 0; hit.is_some() && passed < kMostLightsPassed; ++passed) {
          radiance += world.lights.radiance(hit.surface - instances, ray.direction, hit.distance, hit.normal);
          rest.near = hit.distance * (1 + 1e-5f);
          hit = world.tracer.closest(rest, ray::Seen::kLights);
        }
        hit = behind;
      }
      Cell& cell = c.frame.cells[pixel];
      cell = {};
      if (hit.is_some() && hit.surface < instances) {
        world.surfaces.at<surface::Detail::kNone>(ray, hit, point);
        if (!has_textures || point.material->emission_map == nullptr) radiance += world.surfaces.emission(point);
        if (has_textures) c.frame.hits[pixel] = {hit.distance, hit.u, hit.v, hit.surface, hit.triangle};
        if (!point.is_black()) {
          cell = {point.position, point.normal, point.shading_normal, point.uv,
                  world.scene.instances[hit.surface].material};
          tile.low = glm::min(tile.low, cell.position), tile.high = glm::max(tile.high, cell.position);
          normals += cell.normal;
          kept[static_cast<std::size_t>(tile.surfaces++)] = cell.normal;
        }
      } else if (world.lights.environment()) {
        radiance += world.lights.environment()->radiance(ray.direction);
      }
      const auto out = c.frame.radiance.at(x, y);
      for (std::size_t k = 0; k < 3; ++k)
        out[k] += radiance[static_cast<int>(k)] / static_cast<float>(c.settings.pixel_samples);
    }
  const float length = glm::length(normals);
  tile.axis = length > 1e-6f ? normals / length : glm::vec3(0, 0, 1);
  tile.cosine = length > 1e-6f ? 1.0f : -1.0f;
  for (int k = 0; k < tile.surfaces; ++k)
    tile.cosine = std::min(tile.cosine, glm::dot(tile.axis, kept[static_cast<std::size_t>(k)]));
}

}  // namespace

ray::Ray camera_ray(const Context& c, int x, int y) {
  glm::vec2 in_pixel(0.5f), on_lens(0.5f);
  if (c.settings.pixel_samples > 1 || c.camera.has_lens()) {
    sampling::Samples samples(static_cast<std::uint32_t>(c.frame.pixel(x, y)), c.sample, c.settings.seed);
    const glm::vec2 u = samples.next(), v = samples.next();
    if (c.settings.pixel_samples > 1) in_pixel = u;
    on_lens = v;
  }
  return c.camera.ray(glm::vec2(x, y) + in_pixel, on_lens);
}

Pass visibility_pass(const plan::Plan& plan) {
  const bool is_textured = has_textures(plan);
  Pass pass{"visibility",
            "camera rays in packets; what each pixel shows, and what each tile contains",
            {},
            {Buffer::kSurfaces, Buffer::kTiles, Buffer::kRadiance},
            [=](Context& c) {
              if (is_textured) c.frame.hits.resize(c.frame.cells.size());
              for_tiles(c.frame, false, [&](Tile& tile) { show(c, tile, is_textured); });
            }};
  if (is_textured) pass.writes.push_back(Buffer::kHits);
  return pass;
}

}  // namespace likeness::runtime
