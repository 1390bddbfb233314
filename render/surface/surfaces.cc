#include "render/surface/surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "brdf/normal_length.h"
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
[[gnu::always_inline]] inline glm::vec3 facing(const glm::vec3& normal, const glm::vec3& to_view,
                                               const glm::vec3& geometric) {
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

// The frame of a point whose normal is known. Vectors are values, and stored last: what lies in `p` is read again after
// each store to it.
[[gnu::always_inline]] inline void look_from(glm::vec3 to_view, glm::vec3 normal, glm::vec3 geometric, Point& p) {
  normal = facing(normal, to_view, geometric);
  const ray::Frame frame(normal);
  const glm::vec3 local = frame.local(to_view);
  p.shading_normal = normal, p.frame = frame, p.to_view = local;
}

// How textures are read: at full size,
struct AtFullSize {
  const void* model(Point& p) const { return p.material->model_at(p.uv, p.scratch); }
  // The normal of a map's texel in the frame of the tangents; `turned` is -1 from behind.
  glm::vec3 normal(const Point& p, float turned) const {
    return map(*p.material->normal_map, *of(p).normal_map, p, turned);
  }
  glm::vec3 diffuse_normal(const Point& p, float turned) const {
    return map(*p.material->diffuse_normal_map, *of(p).diffuse_normal_map, p, turned);
  }
  void finish(Point&) const {}

 private:
  static const scene::Material& of(const Point& p) { return *p.material->material; }
  static glm::vec3 map(const scene::Image& image, const scene::Texture& texture, const Point& p, float turned) {
    return texture::normal_at(image, texture, p.uv, turned * of(p).normal_strength);
  }
};

// or over a pixel.
struct OverPixel {
  const MaterialLevels& levels;
  texture::Footprint footprint;
  texture::Filter filter;
  float deficit = 0, diffuse_deficit = 0;  // of the bumps that the pixel does not show

  const void* model(Point& p) const { return model_over(*p.material, levels, p.uv, footprint, filter, p.scratch); }
  glm::vec3 normal(const Point& p, float turned) {
    const glm::vec3 n = map(*levels.normal, p, turned, deficit);
    diffuse_deficit = deficit;
    return n;
  }
  glm::vec3 diffuse_normal(const Point& p, float turned) {
    return map(*levels.diffuse_normal, p, turned, diffuse_deficit);
  }
  void finish(Point& p) const {
    if (deficit > 0 && p.material->roughness_at != kNoPlace) {
      if (p.bound.model != &p.scratch) std::memcpy(&p.scratch, p.bound.model, p.material->model_bytes);
      p.bound.model = &p.scratch;
      roughen(*p.material, deficit, p.scratch);
    }
    if (diffuse_deficit > 0) p.bound.bumps = brdf::alpha_of_normal_deficit<1>(diffuse_deficit);
  }

 private:
  glm::vec3 map(const texture::Levels& map, const Point& p, float turned, float& lost) const {
    const texture::Levels::MeanNormal mean = map.normal(p.uv, footprint, filter);
    lost = mean.deficit;
    return {turned * mean.normal.x, turned * mean.normal.y, mean.normal.z};
  }
};

}  // namespace

Surfaces::Surfaces(const scene::Scene& scene, const ray::Tracer& tracer, const std::vector<Prepared>& materials) {
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    const glm::mat3 linear(instance.world_from_object);
    placed_.push_back({&scene.meshes[instance.mesh], &materials[instance.material],
                       tracer.vertices(static_cast<scene::Index>(i)), glm::transpose(glm::inverse(linear)), linear,
                       glm::vec3(instance.world_from_object[3]), glm::length(linear[0]), glm::determinant(linear) < 0});
    turns_.push_back(model_from_world(linear));
  }
}

glm::vec2 Surfaces::uv_at(scene::Index instance, scene::Index triangle, float u, float v) const {
  const scene::Mesh& mesh = *placed_[instance].mesh;
  if (mesh.uvs.empty()) return {0, 0};
  const auto& corners = mesh.triangles[triangle];
  return (1 - u - v) * mesh.uvs[corners[0]] + u * mesh.uvs[corners[1]] + v * mesh.uvs[corners[2]];
}

template <Detail kDetail>
[[gnu::always_inline]] inline glm::vec3 Surfaces::meet(const ray::Ray& ray, const ray::Hit& hit, Point& p) const {
  const Placed& placed = placed_[hit.surface];
  const scene::Mesh& mesh = *placed.mesh;
  const glm::vec3 to_view = -ray.direction;
  glm::vec3 position, geometric, normal;
  if (mesh.is_sphere) {
    geometric = glm::normalize(ray.origin + hit.distance * ray.direction - placed.center);
    position = placed.center + placed.radius * geometric;
    normal = geometric;
    if constexpr (kDetail != Detail::kShape)
      p.uv = uv_of_sphere(glm::normalize(glm::transpose(placed.world_from_object) * geometric));
  } else {
    const auto& corners = mesh.triangles[hit.triangle];
    const float u = hit.u, v = hit.v, w = 1 - u - v;
    const glm::vec3 a = corner(placed.vertices, corners[0]), b = corner(placed.vertices, corners[1]),
                    c = corner(placed.vertices, corners[2]);
    position = w * a + u * b + v * c;
    geometric = normalized_or(placed.is_mirrored ? glm::cross(c - a, b - a) : glm::cross(b - a, c - a), to_view);
    normal = geometric;
    if (!mesh.normals.empty()) {
      const glm::vec3 smooth =
          w * mesh.normals[corners[0]] + u * mesh.normals[corners[1]] + v * mesh.normals[corners[2]];
      normal = normalized_or(placed.normal_from_object * smooth, geometric);
      // The corners' order says nothing that their normals contradict.
      if (glm::dot(normal, geometric) < 0) geometric = -geometric;
    }
    if constexpr (kDetail != Detail::kShape)
      p.uv = mesh.uvs.empty() ? glm::vec2(0)
                              : w * mesh.uvs[corners[0]] + u * mesh.uvs[corners[1]] + v * mesh.uvs[corners[2]];
  }
  const bool is_back = glm::dot(geometric, to_view) < 0;
  if (is_back) geometric = -geometric, normal = -normal;
  p.instance = hit.surface, p.triangle = hit.triangle, p.material = placed.material;
  p.kernel = &placed.material->kernel;
  p.position = position, p.normal = geometric, p.is_back = is_back;
  return normal;
}

template <class Textures>
void Surfaces::dress(const ray::Hit& hit, glm::vec3 normal, const glm::vec3& to_view, Textures&& textures,
                     Point& p) const {
  const Prepared& material = *p.material;
  p.bound = {};
  p.bound.model = textures.model(p);
  if (material.normal_map != nullptr || material.diffuse_normal_map != nullptr) {
    const Placed& placed = placed_[hit.surface];
    const scene::Mesh& mesh = *placed.mesh;
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
    const float turned = p.is_back ? -1.0f : 1.0f;
    const glm::vec3 mapped = material.normal_map == nullptr ? normal : tangents.world(textures.normal(p, turned));
    if (material.has_dual_normals()) {
      const glm::vec3 diffuse = tangents.world(textures.diffuse_normal(p, turned));
      p.shading_normal = facing(normal, to_view, p.normal);
      p.frame = ray::Frame(p.shading_normal);
      if (material.normal_map != nullptr) p.bound.specular_normal = p.frame.local(mapped);
      p.bound.diffuse_normal = p.frame.local(diffuse);
      p.to_view = p.frame.local(to_view);
      textures.finish(p);
      return;
    }
    normal = mapped;
  }
  textures.finish(p);
  look_from(to_view, normal, p.normal, p);
}

template <Detail kDetail>
void Surfaces::at(const ray::Ray& ray, const ray::Hit& hit, Point& p) const {
  const glm::vec3 normal = meet<kDetail>(ray, hit, p), to_view = -ray.direction;
  if constexpr (kDetail == Detail::kTextures) {
    dress(hit, normal, to_view, AtFullSize{}, p);
    if (p.material->bake != nullptr) [[unlikely]]
      add_residual(hit.surface, p);
  } else {
    p.bound.model = &p.material->model;
    look_from(to_view, normal, p.normal, p);
  }
}

void Surfaces::over(const ray::Ray& ray, const ray::Hit& hit, const Pixel& pixel, Point& p) const {
  const glm::vec3 normal = meet<Detail::kTextures>(ray, hit, p);
  dress(hit, normal, -ray.direction,
        OverPixel{pixel.levels.of(*p.material), footprint(ray, hit, p, pixel), pixel.filter}, p);
  if (p.material->bake != nullptr) [[unlikely]]
    add_residual(hit.surface, p);
}

template void Surfaces::at<Detail::kShape>(const ray::Ray&, const ray::Hit&, Point&) const;
template void Surfaces::at<Detail::kNone>(const ray::Ray&, const ray::Hit&, Point&) const;
template void Surfaces::at<Detail::kTextures>(const ray::Ray&, const ray::Hit&, Point&) const;

// Source  Igehy, "Tracing Ray Differentials", SIGGRAPH 1999, for the plane of the triangle; a sphere's uv by its tangent
//         plane. The cosine between view and plane is kept above 1e-4.
texture::Footprint Surfaces::footprint(const ray::Ray& ray, const ray::Hit& hit, const Point& p,
                                       const Pixel& pixel) const {
  const Placed& placed = placed_[hit.surface];
  const scene::Mesh& mesh = *placed.mesh;
  const float cosine = std::min(glm::dot(p.normal, ray.direction), -1e-4f);
  const float distance = glm::length(p.position - ray.origin);
  const auto moved = [&](const glm::vec3& turn) {
    return distance * (turn - (glm::dot(p.normal, turn) / cosine) * ray.direction);
  };
  const glm::vec3 right = moved(pixel.right), down = moved(pixel.down);
  const auto finite = [](const glm::vec2& uv) {
    return std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : glm::vec2(0);
  };
  if (mesh.is_sphere) {
    const glm::mat3 object_from_world = glm::transpose(placed.world_from_object) / (placed.radius * placed.radius);
    const glm::vec3 at = object_from_world * (p.position - placed.center);
    const float across2 = std::max(at.x * at.x + at.z * at.z, 1e-6f);  // at a pole u says nothing
    const auto uv = [&](const glm::vec3& world) {
      const glm::vec3 d = object_from_world * world;
      return finite({(at.z * d.x - at.x * d.z) / (2 * kPi * across2), -d.y / (kPi * std::sqrt(across2))});
    };
    return {uv(right), uv(down)};
  }
  if (mesh.uvs.empty()) return {};
  const auto& corners = mesh.triangles[hit.triangle];
  const glm::vec3 a = corner(placed.vertices, corners[0]);
  const glm::vec3 ab = corner(placed.vertices, corners[1]) - a, ac = corner(placed.vertices, corners[2]) - a;
  const glm::vec3 normal = glm::cross(ab, ac);
  const float per_area2 = 1 / glm::dot(normal, normal);
  const glm::vec2 uv_ab = mesh.uvs[corners[1]] - mesh.uvs[corners[0]],
                  uv_ac = mesh.uvs[corners[2]] - mesh.uvs[corners[0]];
  const auto uv = [&](const glm::vec3& d) {
    return finite(glm::dot(glm::cross(d, ac), normal) * per_area2 * uv_ab +
                  glm::dot(glm::cross(ab, d), normal) * per_area2 * uv_ac);
  };
  return {uv(right), uv(down)};
}

namespace {

template <class Read>
glm::vec3 emission_by(const Point& p, Read&& read) {
  if (!p.material->emits || p.is_black()) return glm::vec3(0);
  glm::vec3 radiance = p.material->material->emission;
  if (p.material->emission_map != nullptr) radiance *= glm::max(read(), glm::vec3(0));
  return radiance;
}

}  // namespace

glm::vec3 Surfaces::emission(const Point& p) const {
  return emission_by(
      p, [&] { return texture::color_at(*p.material->emission_map, *p.material->material->emission_map, p.uv); });
}

glm::vec3 Surfaces::emission_over(const ray::Ray& ray, const ray::Hit& hit, const Pixel& pixel, const Point& p) const {
  return emission_by(p, [&] {
    return pixel.levels.of(*p.material).emission->color(p.uv, footprint(ray, hit, p, pixel), pixel.filter);
  });
}

}  // namespace likeness::surface
