#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "render/scene/scene.h"

// Small scenes, as values.
namespace likeness::runtime::test {

// At `from`, looking at `to`, with a vertical field of view.
inline scene::Camera camera_at(const glm::vec3& from, const glm::vec3& to, float fov_deg, int width, int height) {
  scene::Camera c;
  const glm::vec3 z = glm::normalize(from - to), x = glm::normalize(glm::cross(glm::vec3(0, 1, 0), z));
  const glm::vec3 y = glm::cross(z, x);
  c.world_from_camera = glm::mat4(glm::vec4(x, 0), glm::vec4(y, 0), glm::vec4(z, 0), glm::vec4(from, 1));
  c.width = width, c.height = height;
  c.focal_x = c.focal_y = 0.5 * height / std::tan(0.5 * static_cast<double>(fov_deg) * std::numbers::pi / 180);
  c.center_x = 0.5 * width, c.center_y = 0.5 * height;
  return c;
}

inline scene::Index add_material(scene::Scene& s, brdf::AnyBrdf brdf, std::string name = {}) {
  scene::Material m;
  m.brdf = std::move(brdf), m.name = std::move(name);
  s.materials.push_back(std::move(m));
  return static_cast<scene::Index>(s.materials.size() - 1);
}

inline void add_sphere(scene::Scene& s, scene::Index material, const glm::vec3& center, float radius) {
  scene::Mesh mesh;
  mesh.is_sphere = true;
  s.meshes.push_back(mesh);
  glm::mat4 place(radius);
  place[3] = glm::vec4(center, 1);
  s.instances.push_back({"sphere", static_cast<scene::Index>(s.meshes.size() - 1), material, place});
}

// The quadrilateral a, b, c, d, with uvs (0, 0), (1, 0), (1, 1), (0, 1).
inline void add_quad(scene::Scene& s, scene::Index material, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                     const glm::vec3& d) {
  scene::Mesh mesh;
  mesh.positions = {a, b, c, d};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  s.meshes.push_back(mesh);
  s.instances.push_back({"quad", static_cast<scene::Index>(s.meshes.size() - 1), material, glm::mat4(1)});
}

// Two spheres, one of them Callisto with all of its parts, on a floor; no light.
inline scene::Scene spheres() {
  scene::Scene s;
  s.cameras.push_back(camera_at({0, 1.5f, 5}, {0, 0.7f, 0}, 35, 96, 64));
  brdf::Callisto<double> velvet;
  velvet.base_color = {0.4, 0.1, 0.08};
  velvet.roughness = 0.35, velvet.diffuse_fresnel = 5, velvet.retroreflection = 4, velvet.smooth_terminator = 0.6;
  velvet.dual_specular_opacity = 0.4, velvet.specular_fresnel_falloff = 0.6;
  brdf::Callisto<double> metal;
  metal.base_color = {0.9, 0.7, 0.3};
  metal.metallic = 1, metal.roughness = 0.25;
  const scene::Index floor = add_material(s, brdf::Lambert<double>{}, "floor");
  add_sphere(s, add_material(s, velvet, "velvet"), {-0.9f, 0.8f, 0}, 0.8f);
  add_sphere(s, add_material(s, metal, "metal"), {0.9f, 0.8f, 0}, 0.8f);
  add_quad(s, floor, {-6, 0, 6}, {6, 0, 6}, {6, 0, -6}, {-6, 0, -6});
  return s;
}

inline void add_light(scene::Scene& s, scene::LightShape shape, std::string name = {}) {
  scene::Light light;
  light.shape = shape, light.name = std::move(name);
  s.lights.push_back(std::move(light));
}

}  // namespace likeness::runtime::test
