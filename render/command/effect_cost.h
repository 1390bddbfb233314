#pragma once

#include <cstddef>
#include <functional>

#include "render/plan/draw.h"
#include "render/scene/scene.h"

namespace likeness::render_command {

struct CostOptions {
  std::size_t camera = 0;
  int repeats = 9;          // pairs of readings for each effect
  double seconds = 0.2;     // of CPU, about, for a reading
  int most_pixels = 16384;  // that are rendered: fewer than the camera has, if it has more
};

// What each effect that is on adds: the path tracer on one thread, the scene against plan::without() of it, in turn.
// Throws files::Interrupted. `progress` is told the share that is done.
plan::Costs costs_of(const scene::Scene& scene, const CostOptions& options,
                     const std::function<void(const std::string&, double)>& progress);

}  // namespace likeness::render_command
