#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include <glm/vec3.hpp>

#include "render/scene/scene.h"

// Where a ray meets a scene. The only file that knows Embree is tracer.cc.
namespace likeness::ray {

inline constexpr float kFar = std::numeric_limits<float>::infinity();

// Points origin + t direction with near < t < far. The direction need not be unit, then t counts in its length.
struct Ray {
  glm::vec3 origin{0, 0, 0};
  float near = 0;
  glm::vec3 direction{0, 0, 1};
  float far = kFar;
};

struct Hit {
  float distance = kFar;                // t; kFar: nothing was met
  float u = 0, v = 0;                   // weights of the triangle's second and third corner; of a sphere: 0
  scene::Index surface = scene::kNone;  // instance of the scene, or number of instances + light
  scene::Index triangle = 0;
  glm::vec3 normal{0, 0, 1};  // geometric, not unit; of a triangle (b - a) x (c - a), or against it

  bool is_some() const { return surface != scene::kNone; }
};

// Asked for each candidate on a surface that is cut out: whether there is something at that point. Called from many
// threads at once; must not throw.
struct CutOuts {
  const void* context = nullptr;
  bool (*is_solid)(const void* context, scene::Index instance, scene::Index triangle, float u, float v) = nullptr;
};

struct TracerOptions {
  // No ray slips between two triangles that share an edge, at about a tenth of the speed.
  bool is_watertight = true;
  // Instances with an opacity texture ask `cut_outs`. Off: they are whole, and rays are traced without filters.
  bool has_cut_outs = false;
  CutOuts cut_outs;
};

// What a ray may meet.
enum class Seen : unsigned { kSurfaces = 1, kLights = 2, kAll = 3 };

// A scene made ready for rays. Lights that have an area and are visible are met by closest(), never by occluded().
// All members but the constructor may be called from many threads at once.
//
// Every instance is transformed once, to triangles of the world. Keeps pointers into the scene's meshes; the scene must outlive it
// and keep still.
class Tracer {
 public:
  // Throws std::runtime_error if Embree has no memory for it.
  Tracer(const scene::Scene& scene, const TracerOptions& options);
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;
  ~Tracer();

  // A ray that is empty (far < near), that is no number somewhere or that is farther out than 1e18 meets nothing.
  Hit closest(const Ray& ray, Seen seen = Seen::kAll) const;
  bool occluded(const Ray& ray) const;

  // The same for rays that run close to each other, as those of neighboring pixels and those to one light do: two to
  // three times as fast. Spans of equal length.
  void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> is_occluded) const;

  // The world positions of a mesh's vertices, x y z after each other; null for a sphere and for a mesh without triangles.
  const float* vertices(scene::Index instance) const;

  std::size_t triangles() const;
  std::size_t bytes() const;  // of Embree, roughly

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace likeness::ray
