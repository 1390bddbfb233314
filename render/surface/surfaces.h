#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/ray/frame.h"
#include "render/ray/tracer.h"
#include "render/scene/scene.h"
#include "render/surface/distance.h"
#include "render/surface/materials.h"
#include "render/surface/residual.h"

namespace likeness::surface {

// A point of a surface as whoever looks at it needs it.
struct Point {
  glm::vec3 position{0, 0, 0};
  glm::vec3 normal{0, 0, 1};          // geometric, unit, on the viewer's side
  glm::vec3 shading_normal{0, 0, 1};  // of the mesh, or of its normal map, turned so that the viewer is above it
  ray::Frame frame;                   // of the kernel
  glm::vec3 to_view{0, 0, 1};         // in that frame
  glm::vec2 uv{0, 0};
  scene::Index instance = scene::kNone, triangle = 0;
  const Prepared* material = nullptr;
  const Kernel* kernel = nullptr;  // of the material, or its distant one
  bool is_back = false;            // the viewer is behind it
  Bound bound;
  ModelBytes scratch;   // where bound.model may point to
  ResidualAt residual;  // where bound.residual may point to

  bool has_dual_frame() const { return material->has_dual_normals(); }
  // The normal of the half space that light comes from: residuals take it where the shading normal turns away, too.
  const glm::vec3& light_normal() const { return material->bake != nullptr ? normal : shading_normal; }
  bool is_black() const { return is_back && !material->material->two_sided; }
  Value eval(const glm::vec3& to_light) const {
    if (glm::dot(to_light, normal) <= 0) return {};
    return kernel->eval(bound, frame.local(to_light), to_view);
  }
  glm::vec3 f_cos(const glm::vec3& to_light) const {
    if (glm::dot(to_light, normal) <= 0) return glm::vec3(0);
    return kernel->f_cos(bound, frame.local(to_light), to_view);
  }
  Direction sample(float choice, const glm::vec2& u) const {
    Direction d = kernel->sample(bound, to_view, choice, u);
    d.to_light = frame.world(d.to_light);
    if (glm::dot(d.to_light, normal) <= 0) d.pdf = 0, d.weight = glm::vec3(0);
    return d;
  }
  Lobes lobes(const glm::vec3& to_light) const {
    if (glm::dot(to_light, normal) <= 0) return {};
    return kernel->lobes(bound, frame.local(to_light), to_view);
  }
};

// What may vary over a scene's surfaces; the functions below are compiled for those with and those without.
enum class Detail : std::uint8_t { kShape, kNone, kTextures };

// The surfaces of a scene. Keeps pointers to what it is made of.
class Surfaces {
 public:
  Surfaces(const scene::Scene& scene, const ray::Tracer& tracer, const std::vector<Prepared>& materials);

  // The point that a ray met. `hit` is on an instance, not on a light. kNone: no material has a texture, normal maps and
  // dual normals included; kShape: and nobody reads uv, which is not set. point.bound may
  // point into `point`: it is not to be copied. Of a point that was never met with textures, without them only
  // bound.model is set.
  template <Detail kDetail>
  void at(const ray::Ray& ray, const ray::Hit& hit, Point& point) const;

  // The same for all that a pixel sees, about the point that its ray met.
  void over(const ray::Ray& ray, const ray::Hit& hit, const Pixel& pixel, Point& point) const;

  // How far uv moves when the pixel moves by one. A mesh without uvs, or triangles without an area in uv: zero.
  texture::Footprint footprint(const ray::Ray& ray, const ray::Hit& hit, const Point& point, const Pixel& pixel) const;

  // Radiance that the point sends to its viewer on its own [W/(m^2 sr)].
  glm::vec3 emission(const Point& point) const;
  glm::vec3 emission_over(const ray::Ray& ray, const ray::Hit& hit, const Pixel& pixel, const Point& point) const;

  // How the directions of a bake's lobes lie in an instance: model space from the world's.
  const glm::mat3& turn(scene::Index instance) const { return turns_[instance]; }

  glm::vec2 uv_at(scene::Index instance, scene::Index triangle, float u, float v) const;

 private:
  struct Placed {
    const scene::Mesh* mesh;
    const Prepared* material;
    const float* vertices;
    glm::mat3 normal_from_object, world_from_object;
    glm::vec3 center;  // of a sphere
    float radius;
    bool is_mirrored;  // the order of corners says the other side
  };
  // Position, geometry and uv; returns the mesh's own normal, on the viewer's side.
  template <Detail kDetail>
  glm::vec3 meet(const ray::Ray& ray, const ray::Hit& hit, Point& point) const;
  template <class Textures>
  void dress(const ray::Hit& hit, glm::vec3 normal, const glm::vec3& to_view, Textures&& textures, Point& point) const;

  [[gnu::noinline, gnu::cold]] void add_residual(scene::Index instance, Point& point) const;

  std::vector<Placed> placed_;
  std::vector<glm::mat3> turns_;
};

// Points a point with a frame to the bake of its material: all lobes of the four texels about uv. `weight` is what
// point.residual.weight is to be.
void bind_residual(const glm::mat3& model_from_world, float weight, Point& point);

}  // namespace likeness::surface
