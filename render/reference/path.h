#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "render/ray/tracer.h"
#include "render/sampling/sobol.h"
#include "render/world/world.h"

// One path through a scene: unbiased, by next-event estimation and sampling of the surface, weighted by the power
// heuristic (Veach and Guibas 1995), ended by Russian roulette.
namespace likeness::reference {

// What the function below is compiled for: the rest costs nothing.
enum PathPart : unsigned {
  kLights = 1,       // directions are chosen by lights: any but an environment that is the same everywhere
  kFound = 2,        // by chance rays find such lights too: both ways are weighed against each other; with kLights
  kEnvironment = 4,  // rays that leave the scene see something
  kEmission = 8,     // surfaces shine; with kFound
  kTextures = 16,    // parameters or normals vary over surfaces
  kLayers = 32,      // `first` is filled
  kPathParts = 64
};
unsigned path_parts(const plan::Plan& plan, bool has_layers);

// What pictures are kept of beside the light itself: at the first surface that a camera ray meets.
struct First {
  float depth = 0;  // distance along the ray [m]
  glm::vec3 position{0, 0, 0}, normal{0, 0, 0}, shading_normal{0, 0, 0}, base_color{0, 0, 0};
  glm::vec2 uv{0, 0};
  scene::Index instance = scene::kNone;
  glm::vec3 emitted{0, 0, 0};                     // light that came without a surface, or from the surface itself
  glm::vec3 direct{0, 0, 0}, indirect{0, 0, 0};   // of one bounce, of more
  glm::vec3 diffuse{0, 0, 0}, specular{0, 0, 0};  // direct + indirect by the lobe of the first surface
};

struct PathOptions {
  int max_bounces = 64;  // of light between camera and source; 1: direct light only
  // Numbers that nothing in the scene reads are not made; the others stay the same (sampling::Samples::skip).
  bool reads_choice = true, reads_light_point = true;
};

PathOptions path_options(const world::World& world, int max_bounces);

// The radiance that arrives along a ray [W/(m^2 sr)]: an estimate. NaN and infinity are passed on. `point` is where the
// path keeps the surface that it is at: one for many paths, because making one costs as much as a hundredth of a path.
using PathFunction = glm::vec3 (*)(const world::World& world, ray::Ray ray, sampling::Samples& samples,
                                   const PathOptions& options, surface::Point& point, First* first);
PathFunction path_function(unsigned parts);

}  // namespace likeness::reference
