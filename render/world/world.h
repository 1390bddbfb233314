#pragma once

#include <vector>

#include "render/light/lights.h"
#include "render/plan/plan.h"
#include "render/ray/tracer.h"
#include "render/scene/scene.h"
#include "render/surface/surfaces.h"

namespace likeness::world {

// A scene with all that rendering it needs, built once: what the plan does not call for is not there.
struct World {
  // Keeps the scene, which must outlive it and keep still. Throws std::runtime_error.
  World(const scene::Scene& scene, const plan::Plan& plan, bool is_watertight = true);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const scene::Scene& scene;
  const plan::Plan plan;
  const std::vector<surface::Prepared> materials;
  const ray::Tracer tracer;
  const surface::Surfaces surfaces;
  const light::Lights lights;

 private:
  static bool is_solid(const void* world, scene::Index instance, scene::Index triangle, float u, float v);
};

}  // namespace likeness::world
