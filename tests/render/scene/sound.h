#pragma once

#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/scene/read_scene.h"

// The promises of read_scene.h, said of a scene: empty, or the first that does not hold.
namespace likeness::scene::test {

inline bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline bool is_unit(const glm::vec3& v) { return std::abs(glm::length(v) - 1) < 1e-4f; }

inline std::string fault_of(const Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  if (mesh.is_sphere) return count == 0 && mesh.triangles.empty() ? "" : "a sphere has triangles";
  if (mesh.triangles.empty()) return "a mesh has no triangles";
  if (!mesh.normals.empty() && mesh.normals.size() != count) return "normals are not one for each position";
  if (!mesh.uvs.empty() && mesh.uvs.size() != count) return "uvs are not one for each position";
  if (!mesh.tangents.empty() && mesh.tangents.size() != count) return "tangents are not one for each position";
  for (const auto& t : mesh.triangles)
    for (const Index corner : t)
      if (corner >= count) return "an index is outside";
  for (const glm::vec3& p : mesh.positions)
    if (!is_finite(p) || std::abs(p.x) + std::abs(p.y) + std::abs(p.z) > 3.1e9f) return "a position is no number";
  for (const glm::vec3& n : mesh.normals)
    if (!is_unit(n)) return "a normal is not unit";
  for (const glm::vec2& uv : mesh.uvs)
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return "a uv is no number";
  for (const glm::vec4& t : mesh.tangents)
    if (!is_unit(glm::vec3(t)) || (t.w != 1 && t.w != -1)) return "a tangent is not unit";
  return "";
}

inline std::string fault_of(const Scene& scene, const Texture& texture) {
  if (texture.image >= scene.images.size()) return "a texture's picture is not there";
  if (texture.channel < 0 || texture.channel >= scene.images[texture.image].texels.channels)
    return "a texture's channel is not there";
  if (!is_finite(texture.scale) || !is_finite(texture.offset)) return "a texture's scale is no number";
  return "";
}

inline std::string fault_of(const Scene& scene, const Material& material) {
  if (!is_finite(material.emission)) return "an emission is no number";
  for (const Material::Binding& binding : material.bindings)
    if (const std::string fault = fault_of(scene, binding.texture); !fault.empty()) return fault;
  for (const auto* map :
       {&material.normal_map, &material.diffuse_normal_map, &material.opacity, &material.emission_map})
    if (*map)
      if (const std::string fault = fault_of(scene, **map); !fault.empty()) return fault;
  return "";
}

inline std::string fault_of(const Scene& scene, const Instance& instance) {
  if (instance.mesh >= scene.meshes.size() || instance.material >= scene.materials.size())
    return "an instance's index is outside";
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(instance.world_from_object[c][r])) return "a transform is no number";
  if (glm::determinant(glm::dmat3(instance.world_from_object)) == 0) return "a transform is flat";
  const Mesh& mesh = scene.meshes[instance.mesh];
  const Material& material = scene.materials[instance.material];
  const glm::mat3 turn(instance.world_from_object);
  const float a = glm::dot(turn[0], turn[0]), off = 1e-5f * a;
  if (mesh.is_sphere && (std::abs(glm::dot(turn[1], turn[1]) - a) > off || std::abs(glm::dot(turn[0], turn[1])) > off))
    return "a sphere is not round";
  if (mesh.is_sphere) return "";
  const bool has_map = material.normal_map || material.diffuse_normal_map;
  if (has_map && mesh.tangents.empty()) return "a normal map has no tangents";
  if ((has_map || !material.bindings.empty() || material.opacity || material.emission_map) && mesh.uvs.empty())
    return "a texture has no uvs";
  return "";
}

struct LightFault {
  std::string operator()(const PointLight& l) const {
    return is_finite(l.intensity) && is_finite(l.position) ? "" : "point";
  }
  std::string operator()(const SpotLight& l) const {
    return is_finite(l.intensity) && is_unit(l.direction) && l.inner <= l.outer && l.outer > 0 ? "" : "spot";
  }
  std::string operator()(const DirectionalLight& l) const {
    return is_finite(l.irradiance) && is_unit(l.direction) ? "" : "directional";
  }
  std::string operator()(const RectangleLight& l) const {
    const float area = glm::length(glm::cross(l.half_u, l.half_v));
    return is_finite(l.radiance) && is_finite(l.center) && area > 0 && std::isfinite(area) ? "" : "rectangle";
  }
  std::string operator()(const DiskLight& l) const {
    return is_finite(l.radiance) && is_unit(l.normal) && l.radius > 0 ? "" : "disk";
  }
  std::string operator()(const SphereLight& l) const { return is_finite(l.radiance) && l.radius > 0 ? "" : "sphere"; }
};

inline std::string fault_of(const Scene& scene) {
  std::string fault;
  for (const Mesh& mesh : scene.meshes)
    if (fault = fault_of(mesh); !fault.empty()) return fault;
  for (const Material& material : scene.materials)
    if (fault = fault_of(scene, material); !fault.empty()) return fault;
  for (const Instance& instance : scene.instances)
    if (fault = fault_of(scene, instance); !fault.empty()) return fault;
  for (const Image& image : scene.images)
    for (const float x : image.texels.floats)
      if (!std::isfinite(x)) return "a texel is no number";
  for (const Light& light : scene.lights) {
    if (fault = std::visit(LightFault{}, light.shape); !fault.empty()) return fault + " light is not sound";
    if (!(light.range > 0)) return "a light's range is not above 0";
    if (light.profile != kNone && light.profile >= scene.profiles.size()) return "a light's profile is not there";
  }
  for (const Profile& profile : scene.profiles)
    if (profile.candela.size() != profile.vertical_deg.size() * profile.horizontal_deg.size())
      return "a profile has not as many candela as angles";
  if (scene.cameras.empty()) return "no camera";
  for (const Camera& camera : scene.cameras) {
    if (camera.width < 1 || camera.height < 1 || !(camera.focal_x > 0) || !(camera.focal_y > 0)) return "a camera";
    for (int c = 0; c < 3; ++c)
      if (!is_unit(glm::vec3(camera.world_from_camera[c]))) return "a camera's frame is not unit";
    if (!is_finite(glm::vec3(camera.world_from_camera[3]))) return "a camera's place is no number";
  }
  if (scene.environment && (!is_finite(scene.environment->scale) ||
                            (scene.environment->image != kNone && scene.environment->image >= scene.images.size())))
    return "the environment is not sound";
  return "";
}

}  // namespace likeness::scene::test
