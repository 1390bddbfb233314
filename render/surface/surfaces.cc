#include "render/surface/surfaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/texture/texture.h"

namespace likeness::surface {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Longitude and latitude of a place on a sphere: u to the right as seen from outside, 1/2 at +z; v down from the top.
glm::vec2 uv_of_sphere(const glm::vec3& n) {
  return {0.5f + std::atan2(n.x, n.z) / (2 * kPi), std::acos(std::clamp(n.y, -1.0f, 1.0f)) / kPi};
}

glm::vec3 corner(const float* vertices, scene::Index index) {
  const float* p = vertices + 3 * static_cast<std::size_t>(index);
  return {p[0], p[1], p[2]};
}

// A normal that the viewer is above of: a shading normal, or a mapped one, that turns away from a point that is seen is
// bent back just so far.
glm::vec3 facing(const glm::vec3& normal, const glm::vec3& to_view, const glm::vec3& geometric) {
  constexpr float kLeast = 1e-3f;  // cosine
  const float cosine = glm::dot(normal, to_view);
  if (cosine >= kLeast) return normal;
  const glm::vec3 bent = normal + (kLeast - cosine) * to_view;
  const float length2 = glm::dot(bent, bent);
  return length2 > 1e-12f ? bent / std::sqrt(length2) : geometric;
}

glm::vec3 normalized_or(const glm::vec3& v, const glm::vec3& otherwise) {
  const float length2 = glm::dot(v, v);
  return length2 > 0 && std::isfinite(length2) ? v / std::sqrt(length2) : otherwise;
}

// The normal of a map's texel, in the frame of the tangents.
glm::vec3 mapped(const scene::Image& image, const scene::Texture& texture, const glm::vec2& uv, float strength) {
  const glm::vec3 c = 2.0f * texture::color_at(image, texture, uv) - 1.0f;
  return normalized_or({c.x * strength, c.y * strength, std::max(c.z, 1e-3f)}, {0, 0, 1});
}

}  // namespace

Surfaces::Surfaces(const scene::Scene& scene, const ray::Tracer& tracer, const std::vector<Prepared>& materials) {
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    const glm::mat3 linear(instance.world_from_object);
    placed_.push_back({&scene.meshes[instance.mesh], &materials[instance.material],
                       tracer.vertices(static_cast<scene::Index>(i)), glm::transpose(glm::inverse(linear)), linear,
                       glm::vec3(instance.world_from_object[3]), glm::length(linear[0]), glm::determinant(linear) < 0});
  }
}

glm::vec2 Surfaces::uv_at(scene::Index instance, scene::Index triangle, float u, float v) const {
  const scene::Mesh& mesh = *placed_[instance].mesh;
  if (mesh.uvs.empty()) return {0, 0};
  const auto& corners = mesh.triangles[triangle];
  return (1 - u - v) * mesh.uvs[corners[0]] + u * mesh.uvs[corners[1]] + v * mesh.uvs[corners[2]];
}

template <Detail kDetail>
void Surfaces::at(const ray::Ray& ray, const ray::Hit& hit, Point& p) const {
  const Placed& placed = placed_[hit.surface];
  const scene::Mesh& mesh = *placed.mesh;
  p.instance = hit.surface, p.triangle = hit.triangle, p.material = placed.material;
  const glm::vec3 to_view = -ray.direction;
  glm::vec3 normal;
  if (mesh.is_sphere) {
    p.normal = glm::normalize(ray.origin + hit.distance * ray.direction - placed.center);
    p.position = placed.center + placed.radius * p.normal;
    normal = p.normal;
    p.uv = uv_of_sphere(glm::normalize(glm::transpose(placed.world_from_object) * p.normal));
  } else {
    const auto& corners = mesh.triangles[hit.triangle];
    const float u = hit.u, v = hit.v, w = 1 - u - v;
    const glm::vec3 a = corner(placed.vertices, corners[0]), b = corner(placed.vertices, corners[1]),
                    c = corner(placed.vertices, corners[2]);
    p.position = w * a + u * b + v * c;
    p.normal = normalized_or(placed.is_mirrored ? glm::cross(c - a, b - a) : glm::cross(b - a, c - a), to_view);
    normal = p.normal;
    if (!mesh.normals.empty()) {
      const glm::vec3 smooth =
          w * mesh.normals[corners[0]] + u * mesh.normals[corners[1]] + v * mesh.normals[corners[2]];
      normal = normalized_or(placed.normal_from_object * smooth, p.normal);
      // The corners' order says nothing that their normals contradict.
      if (glm::dot(normal, p.normal) < 0) p.normal = -p.normal;
    }
    p.uv = mesh.uvs.empty() ? glm::vec2(0)
                            : w * mesh.uvs[corners[0]] + u * mesh.uvs[corners[1]] + v * mesh.uvs[corners[2]];
  }
  p.is_back = glm::dot(p.normal, to_view) < 0;
  if (p.is_back) p.normal = -p.normal, normal = -normal;

  p.bound = {};
  if constexpr (kDetail == Detail::kTextures) {
    const Prepared& material = *placed.material;
    p.bound.model = material.model_at(p.uv, p.scratch);
    if (material.normal_map != nullptr || material.diffuse_normal_map != nullptr) {
      glm::vec3 tangent(0);
      float side = 1;
      if (!mesh.tangents.empty()) {
        const auto& corners = mesh.triangles[hit.triangle];
        const float u = hit.u, v = hit.v, w = 1 - u - v;
        tangent = placed.world_from_object *
                  (w * glm::vec3(mesh.tangents[corners[0]]) + u * glm::vec3(mesh.tangents[corners[1]]) +
                   v * glm::vec3(mesh.tangents[corners[2]]));
        side = placed.is_mirrored ? -mesh.tangents[corners[0]].w : mesh.tangents[corners[0]].w;
      } else if (mesh.is_sphere) {
        tangent = glm::cross(placed.world_from_object[1], p.is_back ? -normal : normal);
        if (placed.is_mirrored) tangent = -tangent, side = -1;
      }
      tangent -= glm::dot(tangent, normal) * normal;
      const ray::Frame plain(normal);
      tangent = normalized_or(tangent, plain.x);
      // Seen from behind the frame is turned over as a whole: bumps stay where they are.
      const ray::Frame tangents(tangent, side * glm::cross(p.is_back ? -normal : normal, tangent), normal);
      const float strength = p.is_back ? -material.material->normal_strength : material.material->normal_strength;
      const auto of = [&](const scene::Image* image, const std::optional<scene::Texture>& texture) {
        return image == nullptr ? normal : tangents.world(mapped(*image, *texture, p.uv, strength));
      };
      if (material.has_dual_normals()) {
        normal = facing(normal, to_view, p.normal);
        p.frame = ray::Frame(normal);
        p.bound.specular_normal = p.frame.local(of(material.normal_map, material.material->normal_map));
        p.bound.diffuse_normal = p.frame.local(of(material.diffuse_normal_map, material.material->diffuse_normal_map));
        p.shading_normal = normal;
        p.to_view = p.frame.local(to_view);
        return;
      }
      normal = of(material.normal_map, material.material->normal_map);
    }
  } else {
    p.bound.model = &placed.material->model;
  }
  p.shading_normal = facing(normal, to_view, p.normal);
  p.frame = ray::Frame(p.shading_normal);
  p.to_view = p.frame.local(to_view);
}

template void Surfaces::at<Detail::kNone>(const ray::Ray&, const ray::Hit&, Point&) const;
template void Surfaces::at<Detail::kTextures>(const ray::Ray&, const ray::Hit&, Point&) const;

glm::vec3 Surfaces::emission(const Point& p) const {
  if (!p.material->emits || p.is_black()) return glm::vec3(0);
  glm::vec3 radiance = p.material->material->emission;
  if (p.material->emission_map != nullptr)
    radiance *=
        glm::max(texture::color_at(*p.material->emission_map, *p.material->material->emission_map, p.uv), glm::vec3(0));
  return radiance;
}

}  // namespace likeness::surface
