#pragma once

#include <algorithm>
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "brdf/ggx.h"
#include "brdf/lambert.h"
#include "render/ray/frame.h"
#include "render/ray/offset.h"
#include "render/reference/film.h"
#include "render/sampling/sobol.h"
#include "render/surface/kernel_of_model.h"
#include "render/world/camera.h"
#include "render/world/world.h"

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

  const world::World& world;
  glm::vec3 position, intensity;

  bool surface(const ray::Ray& ray, const ray::Hit& hit, glm::vec3& at, glm::vec3& normal) const {
    const scene::Mesh& mesh = world.scene.meshes[world.scene.instances[hit.surface].mesh];
    const float* vertices = world.tracer.vertices(hit.surface);
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

  const world::World& world;
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
  glm::vec3 position, normal, to_view;  // the latter in the frame
  ray::Frame frame;
  surface::Bound bound;
};
// What light arrives at it, unless it is hidden, and what it sends on.
struct Arriving {
  glm::vec3 to_light, value;
  float distance;
};

template <class World>
bool meet(const World& world, const ray::Ray& ray, const ray::Hit& hit, Point& p) {
  if (!world.surface(ray, hit, p.position, p.normal)) return false;
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
template <class World, class P>
glm::vec3 f_cos(const P& p, const glm::vec3& to_light) {
  if (glm::dot(to_light, p.normal) <= 0) return glm::vec3(0);
  return surface::f_cos_with<typename World::Model, surface::Whole<typename World::Model>>(
      p.bound, p.frame.local(to_light), p.to_view);
}
template <class World, class P>
surface::Direction sample(const P& p, float choice, const glm::vec2& u) {
  using How = surface::Whole<typename World::Model>;
  surface::Direction next = surface::sample_with<typename World::Model, How>(p.bound, p.to_view, choice, u);
  next.to_light = p.frame.world(next.to_light);
  if (glm::dot(next.to_light, p.normal) <= 0) next.pdf = 0;
  return next;
}

// The four above, compiled into the loop around them,
template <class World>
struct Inlined {
  using Point = lean::Point;
  static bool meet(const World& w, const ray::Ray& r, const ray::Hit& h, Point& p) { return lean::meet(w, r, h, p); }
  static Arriving light_at(const World& w, const Point& p) { return lean::light_at(w, p.position); }
  static glm::vec3 f_cos(const Point& p, const glm::vec3& l) { return lean::f_cos<World>(p, l); }
  static surface::Direction sample(const Point& p, float choice, const glm::vec2& u) {
    return lean::sample<World>(p, choice, u);
  }
};
// or called, as they are where each has a room of its own;
template <class World>
struct InRooms : Inlined<World> {
  [[gnu::noinline]] static bool meet(const World& w, const ray::Ray& r, const ray::Hit& h, Point& p) {
    return lean::meet(w, r, h, p);
  }
  [[gnu::noinline]] static Arriving light_at(const World& w, const Point& p) { return lean::light_at(w, p.position); }
  [[gnu::noinline]] static glm::vec3 f_cos(const Point& p, const glm::vec3& l) { return lean::f_cos<World>(p, l); }
  [[gnu::noinline]] static surface::Direction sample(const Point& p, float choice, const glm::vec2& u) {
    return lean::sample<World>(p, choice, u);
  }
};
// then one after the other replaced by ours: the surfaces, which know meshes, spheres, mirrored and smooth ones, and have
// a point for everyone who may ask;
template <class World>
struct OurSurfaces : InRooms<World> {
  using Point = surface::Point;
  static bool meet(const World& w, const ray::Ray& r, const ray::Hit& h, Point& p) {
    w.world.surfaces.template at<surface::Detail::kShape>(r, h, p);
    return !p.is_black();
  }
  static Arriving light_at(const World& w, const Point& p) { return called(w, p.position); }
  [[gnu::noinline]] static glm::vec3 f_cos(const Point& p, const glm::vec3& l) { return lean::f_cos<World>(p, l); }
  [[gnu::noinline]] static surface::Direction sample(const Point& p, float choice, const glm::vec2& u) {
    return lean::sample<World>(p, choice, u);
  }

 private:
  [[gnu::noinline]] static Arriving called(const World& w, const glm::vec3& at) { return lean::light_at(w, at); }
};
// the models behind pointers;
template <class World>
struct OurModels : OurSurfaces<World> {
  static glm::vec3 f_cos(const surface::Point& p, const glm::vec3& l) { return p.f_cos(l); }
  static surface::Direction sample(const surface::Point& p, float choice, const glm::vec2& u) {
    return p.sample(choice, u);
  }
};
// and the lights. What is left to the whole is the loop over pixels and bounces.
template <class World>
struct OurLights : OurModels<World> {
  static light::Sample light_at(const World& w, const surface::Point& p) {
    return w.world.lights.sample(p.position, p.shading_normal, 0.5f, glm::vec2(0.5f));
  }
};

template <template <class> class How, class World>
glm::vec3 follow(const World& world, typename How<World>::Point& p, ray::Ray ray, sampling::Samples& samples) {
  using Call = How<World>;
  glm::vec3 sum(0), throughput(1);
  for (int bounces = 0;; ++bounces) {
    const ray::Hit hit = world.world.tracer.closest(ray);
    if (!hit.is_some()) return sum + throughput * world.environment();
    if (!Call::meet(world, ray, hit, p) || bounces >= kMostBounces) return sum;
    const glm::vec3 origin = ray::beside(p.position, p.normal);
    samples.skip(), samples.skip();  // neither a lobe, nor a light, nor a point of it is chosen
    if constexpr (World::kHasLight) {
      const auto light = Call::light_at(world, p);
      const glm::vec3 f = Call::f_cos(p, light.to_light);
      if (largest(f) > 0 && !world.world.tracer.occluded({origin, 0, light.to_light, light.distance * (1 - 1e-4f)}))
        sum += throughput * f * light.value;
    }
    const surface::Direction next = Call::sample(p, 0, samples.next());
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
  typename How<World>::Point point;
  point.bound.model = &model;
  for (int ty = 0; ty < camera.height(); ty += kTile)
    for (int tx = 0; tx < camera.width(); tx += kTile)
      for (int y = ty; y < std::min(ty + kTile, camera.height()); ++y)
        for (int x = tx; x < std::min(tx + kTile, camera.width()); ++x) {
          const auto pixel =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width()) + static_cast<std::size_t>(x);
          for (std::uint32_t sample = film.samples(pixel); sample < end; ++sample) {
            sampling::Samples samples(static_cast<std::uint32_t>(pixel), sample, 0);
            const ray::Ray ray = camera.ray(glm::vec2(x, y) + samples.next());
            film.add(pixel, follow<How>(world, point, ray, samples), nullptr);
          }
        }
}

}  // namespace likeness::lean
