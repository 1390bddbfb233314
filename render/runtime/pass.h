#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "render/runtime/environment_maps.h"
#include "render/runtime/frame.h"
#include "render/runtime/residual_maps.h"
#include "render/runtime/settings.h"
#include "render/world/camera.h"
#include "render/world/world.h"

namespace likeness::runtime {

struct Context {
  const world::World& world;
  const world::Camera& camera;
  const Settings& settings;
  const EnvironmentMaps& maps;
  const ResidualMaps& residuals;
  const surface::SceneLevels* levels;  // null: textures are read at full size
  Frame& frame;
  std::uint32_t sample = 0;  // of the pixel, 0 to settings.pixel_samples - 1
};

// One step of a frame. What it reads was written by a pass before it; nothing else ties passes to each other.
struct Pass {
  std::string_view name, text;
  std::vector<Buffer> reads, writes;
  std::function<void(Context&)> run;
};

// Whether surfaces have textures, and so a pass that reads them.
bool has_textures(const plan::Plan& plan);

Pass visibility_pass(const plan::Plan& plan);
Pass texture_pass(const plan::Plan& plan);
Pass light_list_pass(const plan::Plan& plan);
Pass direct_pass(const plan::Plan& plan);
Pass environment_pass(const plan::Plan& plan, const Settings& settings);

// Calls `work` for every tile that shows a surface, or for all; on all threads.
void for_tiles(Frame& frame, bool only_surfaces, const std::function<void(Tile&)>& work);

// The ray through a pixel for the sample that is worked on.
ray::Ray camera_ray(const Context& context, int x, int y);

// The point that a cell stands for, as the kernels take it. point.bound may point into `point`.
void restore(const Context& context, std::size_t pixel, surface::Point& point);

}  // namespace likeness::runtime
