#pragma once

#include <functional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/scene/scene.h"

namespace likeness::datasets_synthetic {

// A surface over (s, t) in [0, 1]^2, in steps. Seen from outside s runs to the right and t down: its
// normal is d/dt x d/ds.
struct SurfacePoint {
  glm::dvec3 position{0};
  glm::dvec2 uv{0};  // v downwards
};
using Surface = std::function<SurfacePoint(double s, double t)>;

// Triangles of the surface with normals and texture coordinates. Quadrilaterals one of whose edges has no length (at a
// pole) become one triangle; those of two such edges none.
scene::Mesh mesh_of(const Surface& surface, int steps_s, int steps_t);

// Smooth noise in [-1, 1] over the plane, the same on every machine: random values at whole numbers, joined by
// quintic curves (Perlin 2002). Repeats after `period` in x if that is above 0.
double noise(double x, double y, unsigned seed, int period = 0);

// To so many decimals, as a scene file states it.
double rounded(double value, int decimals);

// Sum of four octaves of it, in about [-1, 1].
double rough_noise(double x, double y, unsigned seed, int period = 0);

}  // namespace likeness::datasets_synthetic
