#include "render/reference/path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "render/ray/offset.h"
#include "render/sampling/heuristic.h"

namespace likeness::reference {
namespace {

constexpr int kMostLightsPassed = 64;  // by one ray, before it meets a surface: lights do not hide what is behind them

// The first bounces are always followed: ending them early saves less time than its noise costs (seen by
// tests/benchmark/cycles/compare.py --scenes cornell with 0 here).
constexpr int kFirstRoulette = 3;

float largest(const glm::vec3& c) { return std::max({c.r, c.g, c.b}); }

// Collects what one path finds; with kLayers, by what it was.
template <unsigned kParts>
struct Sum {
  glm::vec3 radiance{0, 0, 0};
  glm::vec3 diffuse_part{0, 0, 0};  // of the first surface's f cos_i in the direction that the path took
  First* first;

  void add(const glm::vec3& light, int bounces) {
    radiance += light;
    if constexpr ((kParts & kLayers) != 0) {
      if (bounces == 0) return void(first->emitted += light);
      (bounces == 1 ? first->direct : first->indirect) += light;
      first->diffuse += light * diffuse_part, first->specular += light * (1.0f - diffuse_part);
    }
  }
};

glm::vec3 share_of_diffuse(const surface::Lobes& lobes) {
  const glm::vec3 whole = lobes.diffuse + lobes.specular;
  glm::vec3 share(0);
  for (int k = 0; k < 3; ++k) share[k] = whole[k] > 0 ? lobes.diffuse[k] / whole[k] : 0.0f;
  return share;
}

template <unsigned kParts>
glm::vec3 follow(const world::World& world, ray::Ray ray, sampling::Samples& samples, const PathOptions& options,
                 surface::Point& point, First* first) {
  constexpr auto kDetail = (kParts & kTextures) != 0               ? surface::Detail::kTextures
                           : (kParts & (kEmission | kLayers)) != 0 ? surface::Detail::kNone
                                                                   : surface::Detail::kShape;
  [[maybe_unused]] const std::size_t instances = world.scene.instances.size();
  Sum<kParts> sum;
  sum.first = first;
  glm::vec3 throughput(1);
  // Of the ray's direction, by the surface that it left; 0: the camera's, or nothing else finds it. With kFound.
  [[maybe_unused]] float pdf = 0;
  [[maybe_unused]] glm::vec3 from(0), from_normal(0);

  for (int bounces = 0;; ++bounces) {
    ray::Hit hit = world.tracer.closest(ray);
    if constexpr ((kParts & kFound) != 0) {
      if (hit.is_some() && hit.surface >= instances) {
        // The surface behind is looked for from the start, so that a wall that a light is flush with is not slipped past.
        const ray::Hit behind = world.tracer.closest(ray, ray::Seen::kSurfaces);
        ray::Ray rest = ray;
        rest.far = behind.distance;
        for (int passed = 0; hit.is_some() && passed < kMostLightsPassed; ++passed) {
          const std::size_t light = hit.surface - instances;
          const glm::vec3 seen = world.lights.radiance(light, ray.direction, hit.distance, hit.normal);
          if (largest(seen) > 0) {
            const float other =
                pdf > 0 ? world.lights.light_pdf(light, from, from_normal, ray.direction, hit.distance) : 0.0f;
            sum.add(throughput * seen * (pdf > 0 ? sampling::power_heuristic(pdf, other) : 1.0f), bounces);
          }
          rest.near = hit.distance * (1 + 1e-5f);
          hit = world.tracer.closest(rest, ray::Seen::kLights);
        }
        hit = behind;
      }
    }
    if (!hit.is_some()) {
      if constexpr ((kParts & kEnvironment) != 0) {
        if (!world.lights.environment()) break;  // every effect is forced, and there is none
        float weight = 1;
        if constexpr ((kParts & kFound) != 0)
          if (pdf > 0 && world.lights.samples_environment())
            weight = sampling::power_heuristic(pdf, world.lights.environment_pdf(from, from_normal, ray.direction));
        sum.add(throughput * world.lights.environment()->radiance(ray.direction) * weight, bounces);
      }
      break;
    }

    world.surfaces.at<kDetail>(ray, hit, point);
    if constexpr ((kParts & kLayers) != 0) {
      if (bounces == 0) {
        first->depth = hit.distance, first->position = point.position, first->normal = point.normal;
        first->shading_normal = point.shading_normal, first->uv = point.uv, first->instance = point.instance;
        first->base_color = point.material->kernel.base_color(point.bound);
      }
    }
    if constexpr ((kParts & kEmission) != 0) {
      const glm::vec3 emitted = world.surfaces.emission(point);
      if (largest(emitted) > 0) {
        float weight = 1;
        if (pdf > 0)
          weight = sampling::power_heuristic(pdf, world.lights.emitter_pdf(hit.surface, hit.triangle, from, from_normal,
                                                                           ray.direction, hit.distance, point.normal));
        sum.add(throughput * emitted * weight, bounces);
      }
    }
    if (point.is_black() || bounces >= options.max_bounces) break;

    const auto facing_light = [&]() -> const glm::vec3& {
      if constexpr ((kParts & kTextures) != 0) return point.light_normal();
      else return point.shading_normal;
    };
    const glm::vec3 position = ray::beside(point.position, point.normal);
    const auto next_if = [&](bool is_read) {
      if (is_read) return samples.next();
      samples.skip();
      return glm::vec2(0.5f);
    };
    const glm::vec2 choice = next_if(options.reads_choice);
    if constexpr ((kParts & kLights) == 0) {
      samples.skip();  // the numbers after it are those of a plan with lights
    } else {
      const glm::vec2 u = next_if(options.reads_light_point);
      const light::Sample light = world.lights.sample(point.position, facing_light(), choice.x, u);
      if (light.is_some()) {
        surface::Value f;
        if ((kParts & kFound) != 0 && light.pdf > 0) f = point.eval(light.to_light);
        else f.f_cos = point.f_cos(light.to_light);
        if (largest(f.f_cos) > 0) {
          // The ends are kept off the surfaces at both: an emissive surface must not shade itself.
          const float far = light.distance == ray::kFar ? ray::kFar : light.distance * (1 - 1e-4f);
          if (!world.tracer.occluded({position, 0, light.to_light, far})) {
            if constexpr ((kParts & kLayers) != 0)
              if (bounces == 0) sum.diffuse_part = share_of_diffuse(point.lobes(light.to_light));
            glm::vec3 arrived = throughput * f.f_cos * light.value;
            if constexpr ((kParts & kFound) != 0)
              if (light.pdf > 0) arrived *= sampling::power_heuristic(light.pdf, f.pdf);
            sum.add(arrived, bounces + 1);
          }
        }
      }
    }

    const surface::Direction next = point.sample(choice.y, samples.next());
    if (!(next.pdf > 0)) break;
    throughput *= next.weight;
    if constexpr ((kParts & kLayers) != 0)
      if (bounces == 0) sum.diffuse_part = share_of_diffuse(point.lobes(next.to_light));
    if (bounces >= kFirstRoulette) {
      const float survival = std::min(largest(throughput), 1.0f);
      if (survival < 1 && !(samples.next_plain() < survival)) break;
      throughput /= survival;
    }
    if (!(largest(throughput) > 0)) break;
    if constexpr ((kParts & kFound) != 0) pdf = next.pdf, from = point.position, from_normal = facing_light();
    ray = {position, 0, next.to_light, ray::kFar};
  }
  return sum.radiance;
}

// A part with those that it needs.
constexpr unsigned whole(unsigned parts) {
  if ((parts & kEmission) != 0) parts |= kFound;
  if ((parts & kFound) != 0) parts |= kLights;
  return parts;
}
template <unsigned... P>
constexpr std::array<PathFunction, sizeof...(P)> functions(std::integer_sequence<unsigned, P...>) {
  return {&follow<whole(P)>...};
}
constexpr auto kFunctions = functions(std::make_integer_sequence<unsigned, kPathParts>{});

}  // namespace

unsigned path_parts(const plan::Plan& plan, bool has_layers) {
  using plan::Effect;
  const auto any = [&](auto... effects) { return (plan.has(effects) || ...); };
  unsigned parts = 0;
  if (any(Effect::kPointLights)) parts |= kLights;
  if (any(Effect::kAreaLights, Effect::kEnvironmentPicture)) parts |= kFound;
  if (any(Effect::kEnvironment)) parts |= kEnvironment;
  if (any(Effect::kEmission)) parts |= kEmission;
  if (any(Effect::kTextures, Effect::kNormalMaps, Effect::kDualNormals, Effect::kRealis)) parts |= kTextures;
  if (has_layers) parts |= kLayers;
  return whole(parts);
}

PathOptions path_options(const world::World& world, int max_bounces) {
  const auto chooses_lobe = [](const scene::Material& material) {
    return material.residual || std::visit(
                                    [](const auto& model) {
                                      const brdf::Vec3<double> up{0.0, 0.0, 1.0};
                                      const auto lobes = model.lobes(up);
                                      return requires { lobes.light(up, 0.0, 0.0, 0.0); };
                                    },
                                    material.brdf);
  };
  const auto& materials = world.scene.materials;
  return {max_bounces, world.lights.reads_choice() || std::any_of(materials.begin(), materials.end(), chooses_lobe),
          world.lights.reads_point()};
}

PathFunction path_function(unsigned parts) { return kFunctions[parts % kPathParts]; }

}  // namespace likeness::reference
