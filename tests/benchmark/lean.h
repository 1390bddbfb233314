#pragma once

#include <algorithm>
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "brdf/ggx.h"
#include "brdf/lambert.h"
#include "render/ray/frame.h"
#include "render/ray/offset.h"
#include "render/ray/tracer.h"
#include "render/reference/film.h"
#include "render/sampling/sobol.h"
#include "render/surface/kernel_of_model.h"
#include "render/world/camera.h"

// Path tracers that know one model and one light, and were compiled for nothing else: no plan, no choice of a kernel, of
// a light, of a shape. They ask for the same random numbers as reference::render() and make the same picture, so that
// what remains between their times is what knowing all the rest costs.
namespace likeness::lean {

inline constexpr int kMostBounces = 64, kFirstRoulette = 3;

inline float largest(const glm::vec3& c) { return std::max({c.r, c.g, c.b}); }

// A normal that the viewer is above of, as surface::Surfaces has it.
inline glm::vec3 facing(const glm::vec3& normal, const glm::vec3& to_view, const glm::vec3& geometric) {
  constexpr float kLeast = 1e-3f;
  const float cosine = glm::dot(normal, to_view);
  if (cosine >= kLeast) return normal;
  const glm::vec3 bent = normal + (kLeast - cosine) * to_view;
  const float length2 = glm::dot(bent, bent);
  return length2 > 1e-12f ? bent / std::sqrt(length2) : geometric;
}

// Meshes of triangles without normals, Lambert, one point light: `scene` has that and nothing else.
struct TrianglesAndPointLight {
  using Model = brdf::Lambert<float>;
  static constexpr bool kHasLight = true;

  const scene::Scene& scene;
  const ray::Tracer& tracer;
  glm::vec3 position, intensity;

  bool surface(const ray::Ray& ray, const ray::Hit& hit, glm::vec3& at, glm::vec3& normal) const {
    const scene::Mesh& mesh = scene.meshes[scene.instances[hit.surface].mesh];
    const float* vertices = tracer.vertices(hit.surface);
    const auto& corners = mesh.triangles[hit.triangle];
    const auto corner = [&](std::size_t k) {
      const float* p = vertices + 3 * static_cast<std::size_t>(corners[k]);
      return glm::vec3(p[0], p[1], p[2]);
    };
    const glm::vec3 a = corner(0), b = corner(1), c = corner(2);
    at = (1 - hit.u - hit.v) * a + hit.u * b + hit.v * c;
    const glm::vec3 cross = glm::cross(b - a, c - a);
    normal = cross / std::sqrt(glm::dot(cross, cross));
    return glm::dot(normal, ray.direction) <= 0;
  }
  glm::vec3 environment() const { return glm::vec3(0); }
};

// One sphere, GGX, the same light from everywhere.
struct SphereAndEnvironment {
  using Model = brdf::Ggx<float>;
  static constexpr bool kHasLight = false;

  const ray::Tracer& tracer;
  glm::vec3 center, radiance;
  float radius;

  bool surface(const ray::Ray& ray, const ray::Hit& hit, glm::vec3& at, glm::vec3& normal) const {
    normal = glm::normalize(ray.origin + hit.distance * ray.direction - center);
    at = center + radius * normal;
    return glm::dot(normal, ray.direction) <= 0;
  }
  glm::vec3 environment() const { return radiance; }
};

template <class World>
glm::vec3 follow(const World& world, const typename World::Model& model, ray::Ray ray, sampling::Samples& samples) {
  using How = surface::Whole<typename World::Model>;
  glm::vec3 sum(0), throughput(1);
  surface::Bound bound;
  bound.model = &model;
  for (int bounces = 0;; ++bounces) {
    const ray::Hit hit = world.tracer.closest(ray);
    if (!hit.is_some()) return sum + throughput * world.environment();
    glm::vec3 at, normal;
    if (!world.surface(ray, hit, at, normal) || bounces >= kMostBounces) return sum;
    const glm::vec3 to_view = -ray.direction;
    const ray::Frame frame(facing(normal, to_view, normal));
    const glm::vec3 local_view = frame.local(to_view), origin = ray::beside(at, normal);

    glm::vec2 choice(0);
    if constexpr (World::kHasLight) {
      samples.skip(), samples.skip();  // neither the light nor a point of it is chosen
      const glm::vec3 way = world.position - at;
      const float distance2 = glm::dot(way, way), distance = std::sqrt(distance2);
      const glm::vec3 to_light = way / distance;
      if (glm::dot(to_light, normal) > 0) {
        const brdf::Geometry<float> g(frame.local(to_light), local_view);
        if (g.above) {
          const glm::vec3 f = surface::to_glm(How::eval(bound, g)) * g.cos_i;
          if (largest(f) > 0 && !world.tracer.occluded({origin, 0, to_light, distance * (1 - 1e-4f)}))
            sum += throughput * f * (world.intensity / distance2);
        }
      }
    } else {
      samples.skip(), samples.skip();
    }
    const surface::Direction next =
        surface::sample_with<typename World::Model, How>(bound, local_view, choice.y, samples.next());
    const glm::vec3 to_light = frame.world(next.to_light);
    if (!(next.pdf > 0) || glm::dot(to_light, normal) <= 0) return sum;
    throughput *= next.weight;
    if (bounces >= kFirstRoulette) {
      const float survival = std::min(largest(throughput), 1.0f);
      if (survival < 1 && !(samples.next_plain() < survival)) return sum;
      throughput /= survival;
    }
    if (!(largest(throughput) > 0)) return sum;
    ray = {origin, 0, to_light, ray::kFar};
  }
}

// One thread; tile by tile, as reference::render() goes.
template <class World>
void render(const World& world, const typename World::Model& model, const world::Camera& camera, std::uint32_t end,
            reference::Film& film) {
  constexpr int kTile = 16;
  for (int ty = 0; ty < camera.height(); ty += kTile)
    for (int tx = 0; tx < camera.width(); tx += kTile)
      for (int y = ty; y < std::min(ty + kTile, camera.height()); ++y)
        for (int x = tx; x < std::min(tx + kTile, camera.width()); ++x) {
          const auto pixel =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width()) + static_cast<std::size_t>(x);
          for (std::uint32_t sample = film.samples(pixel); sample < end; ++sample) {
            sampling::Samples samples(static_cast<std::uint32_t>(pixel), sample, 0);
            const ray::Ray ray = camera.ray(glm::vec2(x, y) + samples.next());
            film.add(pixel, follow(world, model, ray, samples), nullptr);
          }
        }
}

}  // namespace likeness::lean
