#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/geometric.hpp>

#include "render/runtime/pass.h"
#include "render/sampling/sobol.h"

namespace likeness::runtime {
namespace {

struct Work {
  bool has_dual_normals = false, has_proxima = false;
  float pixel = 1;  // side of what a point stands for [pixel]
};

void read_pixel(Context& c, int x, int y, const Work& work, surface::Point& point) {
  const std::size_t pixel = c.frame.pixel(x, y);
  Cell& cell = c.frame.cells[pixel];
  if (!cell.is_surface()) return;
  const surface::Prepared& material = c.world.materials[cell.material];
  const bool shines = material.emits && material.emission_map != nullptr;
  if (!material.has_textures() && !shines) return;

  const ray::Ray ray = camera_ray(c, x, y);
  const HitCell& met = c.frame.hits[pixel];
  const ray::Hit hit{met.distance, met.u, met.v, met.instance, met.triangle};
  glm::vec3 light(0);
  if (c.levels != nullptr) {
    const world::Camera::Spread spread = c.camera.spread(ray.direction, met.distance);
    const surface::Pixel seen{*c.levels, c.settings.textures, work.pixel * spread.right, work.pixel * spread.down};
    c.world.surfaces.over(ray, hit, seen, point);
    if (shines) light = c.world.surfaces.emission_over(ray, hit, seen, point);
  } else {
    c.world.surfaces.at<surface::Detail::kTextures>(ray, hit, point);
    if (shines) light = c.world.surfaces.emission(point);
  }
  cell.shading_normal = point.shading_normal;
  if (work.has_dual_normals) c.frame.dual_cells[pixel] = {point.bound.diffuse_normal, point.bound.specular_normal};
  float* out = c.frame.parameters.data() + pixel * c.frame.parameter_stride;
  *out++ = work.has_proxima ? point.bound.bumps : 0;
  const auto* model = static_cast<const std::byte*>(point.bound.model);
  for (const std::uint16_t place : material.varying) std::memcpy(out++, model + place * sizeof(float), sizeof(float));
  if (material.bake != nullptr) *out++ = point.residual.weight;
  if (shines)
    for (std::size_t k = 0; k < 3; ++k)
      c.frame.radiance.rgb[3 * pixel + k] += light[static_cast<int>(k)] / static_cast<float>(c.settings.pixel_samples);
}

}  // namespace

bool has_textures(const plan::Plan& plan) {
  using plan::Effect;
  return plan.has(Effect::kTextures) || plan.has(Effect::kTextureLevels) || plan.has(Effect::kNormalMaps) ||
         plan.has(Effect::kDualNormals) || plan.has(Effect::kRealis);
}

Pass texture_pass(const plan::Plan& plan) {
  const bool has_dual_normals = plan.has(plan::Effect::kDualNormals), has_proxima = plan.has(plan::Effect::kProxima);
  return {"textures",
          "what textures say of each pixel: parameters, normals, light of their own; over all that it covers",
          {Buffer::kHits, Buffer::kSurfaces, Buffer::kTiles},
          {Buffer::kSurfaces, Buffer::kParameters, Buffer::kRadiance},
          [=](Context& c) {
            std::size_t most = 0;
            for (const surface::Prepared& material : c.world.materials)
              most = std::max(most, material.varying.size() + (material.bake != nullptr ? 1 : 0));
            c.frame.parameter_stride = 1 + most;
            c.frame.parameters.resize(c.frame.parameter_stride * c.frame.cells.size());
            const Work work{has_dual_normals, has_proxima && c.settings.distant_diffuse == DistantDiffuse::kProxima,
                            1 / std::sqrt(static_cast<float>(c.settings.pixel_samples))};
            for_tiles(c.frame, true, [&](Tile& tile) {
              surface::Point point;
              for (int y = tile.y; y < tile.y + tile.height; ++y)
                for (int x = tile.x; x < tile.x + tile.width; ++x) read_pixel(c, x, y, work, point);
            });
          }};
}

// The dominant lobes of the texels, or some drawn by pixel and frame.
[[gnu::noinline, gnu::cold]] static void restore_residual(const Context& context, std::size_t pixel, float weight,
                                                          surface::Point& point) {
  surface::bind_residual(context.world.surfaces.turn(context.frame.hits[pixel].instance), weight, point);
  surface::ResidualAt& at = point.residual;
  if (point.bound.bumps > 0) at.plain = &point.material->plain_distant_kernel;
  at.groups = std::min(at.groups, 1u);
  const int drawn = point.material->material->residual->jitter;
  if (drawn == 0 || at.is_empty()) return;
  constexpr std::uint32_t kJitter = 0x7f4a7c15u;  // other numbers than those of lights
  sampling::Samples numbers(static_cast<std::uint32_t>(pixel), context.sample, context.settings.seed + kJitter);
  at.place(point.uv, drawn, numbers.next());
}

void restore(const Context& context, std::size_t pixel, surface::Point& point) {
  const Cell& cell = context.frame.cells[pixel];
  const surface::Prepared& material = context.world.materials[cell.material];
  point.position = cell.position, point.normal = cell.normal, point.shading_normal = cell.shading_normal;
  point.uv = cell.uv, point.material = &material, point.kernel = &material.kernel, point.is_back = false;
  point.frame = ray::Frame(cell.shading_normal);
  point.to_view = point.frame.local(context.camera.to_view(cell.position));
  point.bound = {};
  point.bound.model = &material.model;
  if (!material.has_textures()) return;
  const float* numbers = context.frame.parameters.data() + pixel * context.frame.parameter_stride;
  point.bound.bumps = *numbers++;
  if (point.bound.bumps > 0) point.kernel = &material.distant_kernel;
  if (!material.varying.empty()) {
    std::memcpy(&point.scratch, &material.model, material.model_bytes);
    for (const std::uint16_t place : material.varying)
      std::memcpy(point.scratch.bytes.data() + place * sizeof(float), numbers++, sizeof(float));
    point.bound.model = &point.scratch;
  }
  if (material.bake != nullptr) [[unlikely]]
    restore_residual(context, pixel, *numbers, point);
  if (material.has_dual_normals()) {
    point.bound.diffuse_normal = context.frame.dual_cells[pixel].diffuse_normal;
    point.bound.specular_normal = context.frame.dual_cells[pixel].specular_normal;
  }
}

}  // namespace likeness::runtime
