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

// What a path needs of a point that it met.
struct Point {
  glm::vec3 at, normal, to_view;  // the latter in the frame
  ray::Frame frame;
};
// What light arrives at it, unless it is hidden, and what it sends on.
struct Arriving {
  glm::vec3 to_light, sent;
  float distance;
};

template <class World>
bool meet(const World& world, const ray::Ray& ray, const ray::Hit& hit, Point& p) {
  if (!world.surface(ray, hit, p.at, p.normal)) return false;
  const glm::vec3 to_view = -ray.direction;
  p.frame = ray::Frame(facing(p.normal, to_view, p.normal));
  p.to_view = p.frame.local(to_view);
  return true;
}
template <class World>
Arriving light_at(const World& world, const glm::vec3& at) {
  const glm::vec3 way = world.position - at;
  const float distance2 = glm::dot(way, way), distance = std::sqrt(distance2);
  return {way / distance, world.intensity / distance2, distance};
}
template <class World>
glm::vec3 f_cos(const surface::Bound& bound, const Point& p, const glm::vec3& to_light) {
  if (glm::dot(to_light, p.normal) <= 0) return glm::vec3(0);
  return surface::f_cos_with<typename World::Model, surface::Whole<typename World::Model>>(
      bound, p.frame.local(to_light), p.to_view);
}
template <class World>
surface::Direction sample(const surface::Bound& bound, const Point& p, float choice, const glm::vec2& u) {
  using How = surface::Whole<typename World::Model>;
  surface::Direction next = surface::sample_with<typename World::Model, How>(bound, p.to_view, choice, u);
  next.to_light = p.frame.world(next.to_light);
  if (glm::dot(next.to_light, p.normal) <= 0) next.pdf = 0;
  return next;
}

// The four above, compiled into the loop around them, or called, as they are where each has a room of its own.
template <class World>
struct Inlined {
  static bool meet(const World& w, const ray::Ray& r, const ray::Hit& h, Point& p) { return lean::meet(w, r, h, p); }
  static Arriving light_at(const World& w, const glm::vec3& at) { return lean::light_at(w, at); }
  static glm::vec3 f_cos(const surface::Bound& b, const Point& p, const glm::vec3& l) {
    return lean::f_cos<World>(b, p, l);
  }
  static surface::Direction sample(const surface::Bound& b, const Point& p, float choice, const glm::vec2& u) {
    return lean::sample<World>(b, p, choice, u);
  }
};
template <class World>
struct InRooms {
  [[gnu::noinline]] static bool meet(const World& w, const ray::Ray& r, const ray::Hit& h, Point& p) {
    return lean::meet(w, r, h, p);
  }
  [[gnu::noinline]] static Arriving light_at(const World& w, const glm::vec3& at) { return lean::light_at(w, at); }
  [[gnu::noinline]] static glm::vec3 f_cos(const surface::Bound& b, const Point& p, const glm::vec3& l) {
    return lean::f_cos<World>(b, p, l);
  }
  [[gnu::noinline]] static surface::Direction sample(const surface::Bound& b, const Point& p, float choice,
                                                     const glm::vec2& u) {
    return lean::sample<World>(b, p, choice, u);
  }
};

template <template <class> class How, class World>
glm::vec3 follow(const World& world, const typename World::Model& model, ray::Ray ray, sampling::Samples& samples) {
  using Call = How<World>;
  glm::vec3 sum(0), throughput(1);
  surface::Bound bound;
  bound.model = &model;
  Point p;
  for (int bounces = 0;; ++bounces) {
    const ray::Hit hit = world.tracer.closest(ray);
    if (!hit.is_some()) return sum + throughput * world.environment();
    if (!Call::meet(world, ray, hit, p) || bounces >= kMostBounces) return sum;
    const glm::vec3 origin = ray::beside(p.at, p.normal);
    samples.skip(), samples.skip();  // neither a lobe, nor a light, nor a point of it is chosen
    if constexpr (World::kHasLight) {
      const Arriving light = Call::light_at(world, p.at);
      const glm::vec3 f = Call::f_cos(bound, p, light.to_light);
      if (largest(f) > 0 && !world.tracer.occluded({origin, 0, light.to_light, light.distance * (1 - 1e-4f)}))
        sum += throughput * f * light.sent;
    }
    const surface::Direction next = Call::sample(bound, p, 0, samples.next());
    if (!(next.pdf > 0)) return sum;
    throughput *= next.weight;
    if (bounces >= kFirstRoulette) {
      const float survival = std::min(largest(throughput), 1.0f);
      if (survival < 1 && !(samples.next_plain() < survival)) return sum;
      throughput /= survival;
    }
    if (!(largest(throughput) > 0)) return sum;
    ray = {origin, 0, next.to_light, ray::kFar};
  }
}

// One thread; tile by tile, as reference::render() goes.
template <template <class> class How, class World>
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
            film.add(pixel, follow<How>(world, model, ray, samples), nullptr);
          }
        }
}

}  // namespace likeness::lean
