#include "render/light/lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/light/area.h"
#include "render/light/profile.h"
#include "render/texture/texture.h"

namespace likeness::light {
namespace {

using std::numbers::pi_v;
constexpr auto kNotOne = static_cast<std::size_t>(-1);

template <class... F>
struct Cases : F... {
  using F::operator()...;
};

// A light without size. `intensity` of a direction towards it and its distance.
template <class Intensity>
Sample towards_point(const glm::vec3& position, const glm::vec3& point, Intensity&& intensity) {
  const glm::vec3 way = position - point;
  const float distance2 = glm::dot(way, way), distance = std::sqrt(distance2);
  if (!(distance2 > 0)) return {};
  const glm::vec3 to_light = way / distance;
  return {to_light, distance, intensity(to_light, distance) / distance2, 0, 0};
}

// 0 below the outer cone, 1 within the inner one.
float cone(const scene::SpotLight& spot, float cosine) {
  const float low = std::cos(spot.outer), high = std::cos(spot.inner);
  if (!(high > low)) return cosine >= low ? 1.0f : 0.0f;
  const float t = std::clamp((cosine - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

}  // namespace

bool has_area(const scene::Light& light) {
  return !std::holds_alternative<scene::PointLight>(light.shape) &&
         !std::holds_alternative<scene::SpotLight>(light.shape) &&
         !std::holds_alternative<scene::DirectionalLight>(light.shape);
}

Lights::Lights(const scene::Scene& scene) : scene_(&scene), emitter_of_(scene.instances.size(), kNotOne) {
  for (const scene::Profile& profile : scene.profiles) largest_candela_.push_back(light::largest_candela(profile));
  if (scene.environment) environment_.emplace(scene, *scene.environment);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    const scene::Material& material = scene.materials[instance.material];
    const scene::Mesh& mesh = scene.meshes[instance.mesh];
    if (brightness(material.emission) <= 0 || mesh.triangles.empty()) continue;
    Emitter emitter;
    emitter.instance = static_cast<scene::Index>(i);
    emitter.radiance = material.emission;
    const glm::mat3 linear(instance.world_from_object);
    emitter.normal_from_object = glm::transpose(glm::inverse(linear));
    emitter.is_mirrored = glm::determinant(linear) < 0;
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (const auto& triangle : mesh.triangles) {
      std::array<glm::vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = glm::vec3(instance.world_from_object * glm::vec4(mesh.positions[triangle[k]], 1));
        low = glm::min(low, p[k]), high = glm::max(high, p[k]);
        emitter.corners.push_back(p[k]);
      }
      emitter.areas.push_back(0.5f * glm::length(glm::cross(p[1] - p[0], p[2] - p[0])));
    }
    emitter.triangles = sampling::Distribution(emitter.areas);
    emitter.area = static_cast<float>(emitter.triangles.sum());
    emitter.center = 0.5f * (low + high), emitter.reach = 0.5f * glm::length(high - low);
    emitter_of_[i] = emitters_.size();
    emitters_.push_back(std::move(emitter));
  }
  reads_point_ =
      std::any_of(scene.lights.begin(), scene.lights.end(), has_area) || !emitters_.empty() || samples_environment();
  if (count() > 1) {
    sample_ = &Lights::one_of_many;
  } else if (count() == 1) {
    const scene::Light* light = scene.lights.empty() ? nullptr : &scene.lights.front();
    const bool is_bare = light != nullptr && std::holds_alternative<scene::PointLight>(light->shape) &&
                         light->profile == scene::kNone && light->range == scene::kForever;
    sample_ = is_bare ? &Lights::bare_point : &Lights::the_one;
  }
}

float Lights::attenuation(const scene::Light& light, float distance) const {
  if (light.range == scene::kForever) return 1;
  const float r = distance / light.range, r2 = r * r, window = std::max(1 - r2 * r2, 0.0f);
  return window * window;
}

Sample Lights::sample_light(std::size_t index, const glm::vec3& point, const glm::vec2& u) const {
  const std::size_t own = scene_->lights.size();
  if (index >= own + emitters_.size()) {
    const Environment::Choice choice = environment_->sample(u);
    if (!(choice.pdf > 0)) return {};
    return {choice.direction, ray::kFar, environment_->radiance(choice.direction) / choice.pdf, choice.pdf, index};
  }
  if (index >= own) {
    Sample s = sample_emitter(emitters_[index - own], point, u);
    s.light = index;
    return s;
  }
  const scene::Light& light = scene_->lights[index];
  const auto profile = [&](const glm::vec3& to_light) {
    if (light.profile == scene::kNone) return 1.0f;
    return relative_intensity(scene_->profiles[light.profile], largest_candela_[light.profile], light.profile_axis,
                              light.profile_zero, -to_light);
  };
  const auto from_point = [&](const glm::vec3& position, const glm::vec3& intensity, auto&& shape) -> Sample {
    Sample s = towards_point(position, point, [&](const glm::vec3& to_light, float distance) {
      return intensity * (shape(to_light) * profile(to_light) * attenuation(light, distance));
    });
    s.light = index;
    return s;
  };
  const auto from_area = [&](const Towards& t, const glm::vec3& radiance) -> Sample {
    if (!(t.pdf > 0)) return {};
    return {t.direction, t.distance, radiance * (attenuation(light, t.distance) / t.pdf),
            light.is_visible ? t.pdf : 0.0f, index};
  };
  return std::visit(
      Cases{
          [&](const scene::PointLight& l) {
            return from_point(l.position, l.intensity, [](const glm::vec3&) { return 1.0f; });
          },
          [&](const scene::SpotLight& l) {
            return from_point(l.position, l.intensity,
                              [&](const glm::vec3& to_light) { return cone(l, -glm::dot(to_light, l.direction)); });
          },
          [&](const scene::DirectionalLight& l) -> Sample { return {-l.direction, ray::kFar, l.irradiance, 0, index}; },
          [&](const scene::RectangleLight& l) { return from_area(sample_rectangle(l, point, u), l.radiance); },
          [&](const scene::DiskLight& l) { return from_area(sample_disk(l, point, u), l.radiance); },
          [&](const scene::SphereLight& l) { return from_area(sample_sphere(l, point, u), l.radiance); },
      },
      light.shape);
}

Sample Lights::sample_emitter(const Emitter& emitter, const glm::vec3& point, const glm::vec2& u) const {
  const auto triangle = emitter.triangles.choose(u.x);
  const glm::vec3* p = emitter.corners.data() + 3 * triangle.index;
  const float root = std::sqrt(triangle.rest), b = 1 - root, d = u.y * root, c = root - d;  // weights of the corners
  const glm::vec3 on_light = b * p[0] + c * p[1] + d * p[2];
  const glm::vec3 way = on_light - point;
  const float distance2 = glm::dot(way, way), distance = std::sqrt(distance2);
  glm::vec3 front = glm::cross(p[1] - p[0], p[2] - p[0]);
  const float twice_area = glm::length(front);
  if (!(distance2 > 0) || !(twice_area > 0)) return {};
  const scene::Instance& instance = scene_->instances[emitter.instance];
  const scene::Material& material = scene_->materials[instance.material];
  const scene::Mesh& mesh = scene_->meshes[instance.mesh];
  const auto& corners = mesh.triangles[triangle.index];
  if (!material.two_sided) {  // as surface::Surfaces has it
    if (emitter.is_mirrored) front = -front;
    if (!mesh.normals.empty()) {
      const glm::vec3 normal =
          emitter.normal_from_object *
          (b * mesh.normals[corners[0]] + c * mesh.normals[corners[1]] + d * mesh.normals[corners[2]]);
      if (glm::dot(normal, front) < 0) front = -front;
    }
  }
  const float facing = -glm::dot(way, front) / (distance * twice_area);
  const float cosine = material.two_sided ? std::abs(facing) : facing;
  if (!(cosine > 0)) return {};
  const glm::vec2 uv =
      mesh.uvs.empty() ? glm::vec2(0) : b * mesh.uvs[corners[0]] + c * mesh.uvs[corners[1]] + d * mesh.uvs[corners[2]];
  const auto image_of = [&](const scene::Texture& texture) -> const scene::Image& {
    return scene_->images[texture.image];
  };
  if (material.opacity &&
      !(texture::number_at(image_of(*material.opacity), *material.opacity, uv) >= material.opacity_cutoff))
    return {};
  glm::vec3 radiance = emitter.radiance;
  if (material.emission_map)
    radiance *= glm::max(texture::color_at(image_of(*material.emission_map), *material.emission_map, uv), glm::vec3(0));
  const float pdf = triangle.probability / (0.5f * twice_area) * distance2 / cosine;
  return {way / distance, distance, radiance / pdf, pdf, 0};
}

// An upper estimate of what a light may send to a point: the brightness of its intensity over the squared distance, or
// of its radiance over the solid angle of a sphere about it; 0 if all of it is below the horizon.
float Lights::weight(std::size_t index, const glm::vec3& point, const glm::vec3& normal) const {
  const std::size_t own = scene_->lights.size();
  const auto near_to = [&](const glm::vec3& center, float reach, float power) {
    const glm::vec3 way = center - point;
    if (glm::dot(way, normal) < -reach) return 0.0f;
    return power / std::max(glm::dot(way, way), std::max(reach * reach, 1e-12f));
  };
  if (index >= own + emitters_.size()) return pi_v<float> * brightness(environment_->mean_radiance());
  if (index >= own) {
    const Emitter& e = emitters_[index - own];
    return near_to(e.center, e.reach, brightness(e.radiance) * e.area);
  }
  const scene::Light& light = scene_->lights[index];
  const auto in_range = [&](const glm::vec3& center, float reach) {
    return light.range == scene::kForever || glm::distance(center, point) < light.range + reach;
  };
  const auto beside = [&](const glm::vec3& center, float reach, float power) {
    return in_range(center, reach) ? near_to(center, reach, power) : 0.0f;
  };
  return std::visit(Cases{
                        [&](const scene::PointLight& l) { return beside(l.position, 0, brightness(l.intensity)); },
                        [&](const scene::SpotLight& l) {
                          const glm::vec3 way = point - l.position;
                          if (glm::dot(way, l.direction) < std::cos(l.outer) * glm::length(way)) return 0.0f;
                          return beside(l.position, 0, brightness(l.intensity));
                        },
                        [&](const scene::DirectionalLight& l) {
                          return glm::dot(l.direction, normal) < 0 ? brightness(l.irradiance) : 0.0f;
                        },
                        [&](const scene::RectangleLight& l) {
                          const glm::vec3 cross = glm::cross(l.half_u, l.half_v);
                          if (!l.two_sided && glm::dot(point - l.center, cross) <= 0) return 0.0f;
                          return beside(l.center, glm::length(l.half_u) + glm::length(l.half_v),
                                        brightness(l.radiance) * 4 * glm::length(cross));
                        },
                        [&](const scene::DiskLight& l) {
                          if (!l.two_sided && glm::dot(point - l.center, l.normal) <= 0) return 0.0f;
                          return beside(l.center, l.radius, brightness(l.radiance) * pi_v<float> * l.radius * l.radius);
                        },
                        [&](const scene::SphereLight& l) {
                          return beside(l.center, l.radius, brightness(l.radiance) * pi_v<float> * l.radius * l.radius);
                        },
                    },
                    light.shape);
}

std::size_t Lights::choose(const glm::vec3& point, const glm::vec3& normal, float choice, float& probability) const {
  const std::size_t lights = count();
  probability = 1;
  if (lights == 1) return 0;
  // One pass, one number: the choice is renewed by what is left of it (weighted reservoir sampling).
  float sum = 0, chosen = 0;
  std::size_t index = kNotOne;
  for (std::size_t i = 0; i < lights; ++i) {
    const float w = weight(i, point, normal);
    if (!(w > 0)) continue;
    sum += w;
    const float p = w / sum;
    if (choice < p) {
      index = i, chosen = w;
      choice = choice / p;
    } else {
      choice = (choice - p) / (1 - p);
    }
  }
  probability = sum > 0 ? chosen / sum : 0.0f;
  return index;
}

float Lights::probability(std::size_t index, const glm::vec3& point, const glm::vec3& normal) const {
  const std::size_t lights = count();
  if (lights == 1) return 1;
  float sum = 0, own = 0;
  for (std::size_t i = 0; i < lights; ++i) {
    const float w = weight(i, point, normal);
    sum += w;
    if (i == index) own = w;
  }
  return sum > 0 ? own / sum : 0.0f;
}

Sample Lights::nothing(const Lights&, const glm::vec3&, const glm::vec3&, float, const glm::vec2&) { return {}; }

Sample Lights::bare_point(const Lights& lights, const glm::vec3& point, const glm::vec3&, float, const glm::vec2&) {
  const auto& light = *std::get_if<scene::PointLight>(&lights.scene_->lights.front().shape);
  return towards_point(light.position, point, [&](const glm::vec3&, float) { return light.intensity; });
}

Sample Lights::the_one(const Lights& lights, const glm::vec3& point, const glm::vec3&, float, const glm::vec2& u) {
  return lights.sample_light(0, point, u);
}

Sample Lights::one_of_many(const Lights& lights, const glm::vec3& point, const glm::vec3& normal, float choice,
                           const glm::vec2& u) {
  float p = 1;
  const std::size_t index = lights.choose(point, normal, choice, p);
  if (index == kNotOne || !(p > 0)) return {};
  Sample s = lights.sample_light(index, point, u);
  s.value = s.value / p;
  s.pdf *= p;
  return s;
}

glm::vec3 Lights::radiance(std::size_t index, const glm::vec3& direction, float distance,
                           const glm::vec3& normal) const {
  const scene::Light& light = scene_->lights[index];
  const auto seen = [&](const glm::vec3& front, bool is_two_sided, const glm::vec3& radiance) {
    if (!is_two_sided && glm::dot(direction, front) >= 0) return glm::vec3(0);
    return radiance * attenuation(light, distance);
  };
  return std::visit(
      Cases{
          [&](const scene::RectangleLight& l) { return seen(glm::cross(l.half_u, l.half_v), l.two_sided, l.radiance); },
          [&](const scene::DiskLight& l) { return seen(l.normal, l.two_sided, l.radiance); },
          [&](const scene::SphereLight& l) { return seen(normal, false, l.radiance); },
          [](const auto&) { return glm::vec3(0); },
      },
      light.shape);
}

Sample Lights::meet(std::size_t index, const glm::vec3& point, const glm::vec3& direction) const {
  if (index >= scene_->lights.size() || !scene_->lights[index].is_visible) return {};
  const scene::Light& light = scene_->lights[index];
  // Where the direction meets the plane of a flat light, from its shining side; 0: nowhere.
  const auto on_plane = [&](const glm::vec3& center, const glm::vec3& normal, bool is_two_sided) {
    const float facing = glm::dot(direction, normal);
    if (facing == 0 || (!is_two_sided && facing > 0)) return 0.0f;
    return std::max(glm::dot(center - point, normal) / facing, 0.0f);
  };
  float distance = 0, pdf = 0;
  glm::vec3 radiance(0);
  std::visit(Cases{
                 [&](const scene::RectangleLight& l) {
                   const float t = on_plane(l.center, glm::cross(l.half_u, l.half_v), l.two_sided);
                   const glm::vec3 across = point + t * direction - l.center;
                   const bool is_inside = std::abs(glm::dot(across, l.half_u)) <= glm::dot(l.half_u, l.half_u) &&
                                          std::abs(glm::dot(across, l.half_v)) <= glm::dot(l.half_v, l.half_v);
                   if (t > 0 && is_inside)
                     distance = t, radiance = l.radiance, pdf = rectangle_pdf(l, point, direction, t);
                 },
                 [&](const scene::DiskLight& l) {
                   const float t = on_plane(l.center, l.normal, l.two_sided);
                   const glm::vec3 across = point + t * direction - l.center;
                   if (t > 0 && glm::dot(across, across) <= l.radius * l.radius)
                     distance = t, radiance = l.radiance, pdf = disk_pdf(l, point, direction, t);
                 },
                 [&](const scene::SphereLight& l) {
                   const glm::vec3 way = l.center - point;
                   const float along = glm::dot(way, direction);
                   const glm::vec3 beside = way - along * direction;
                   const float half2 = l.radius * l.radius - glm::dot(beside, beside);
                   if (along > 0 && half2 > 0 && glm::dot(way, way) > l.radius * l.radius)
                     distance = along - std::sqrt(half2), radiance = l.radiance, pdf = sphere_pdf(l, point);
                 },
                 [](const auto&) {},
             },
             light.shape);
  if (!(distance > 0) || !(pdf > 0)) return {};
  return {direction, distance, radiance * attenuation(light, distance), pdf, index};
}

float Lights::light_pdf(std::size_t index, const glm::vec3& point, const glm::vec3& normal, const glm::vec3& direction,
                        float distance) const {
  const float p = probability(index, point, normal);
  if (!(p > 0)) return 0;
  return p *
         std::visit(Cases{
                        [&](const scene::RectangleLight& l) { return rectangle_pdf(l, point, direction, distance); },
                        [&](const scene::DiskLight& l) { return disk_pdf(l, point, direction, distance); },
                        [&](const scene::SphereLight& l) { return sphere_pdf(l, point); },
                        [](const auto&) { return 0.0f; },
                    },
                    scene_->lights[index].shape);
}

float Lights::emitter_pdf(scene::Index instance, scene::Index triangle, const glm::vec3& point, const glm::vec3& normal,
                          const glm::vec3& direction, float distance, const glm::vec3& surface_normal) const {
  const std::size_t at = emitter_of_[instance];
  if (at == kNotOne) return 0;
  const Emitter& e = emitters_[at];
  const float p = probability(scene_->lights.size() + at, point, normal);
  const float cosine = std::abs(glm::dot(direction, surface_normal));
  if (!(p > 0) || !(cosine > 0) || !(e.areas[triangle] > 0)) return 0;
  return p * e.triangles.probability(triangle) / e.areas[triangle] * distance * distance / cosine;
}

float Lights::environment_pdf(const glm::vec3& point, const glm::vec3& normal, const glm::vec3& direction) const {
  if (!samples_environment()) return 0;
  return probability(environment_index(), point, normal) * environment_->pdf(direction);
}

}  // namespace likeness::light
