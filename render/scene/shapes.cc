#include <cmath>
#include <numbers>

#include "render/scene/mesh_file.h"

namespace likeness::scene {
namespace {

void add_quad(Mesh& mesh, const std::array<glm::vec3, 4>& corners, const glm::vec3& normal, const glm::vec3& along) {
  const auto first = static_cast<Index>(mesh.positions.size());
  constexpr std::array<glm::vec2, 4> kUvs{glm::vec2{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    mesh.positions.push_back(corners[i]);
    mesh.normals.push_back(normal);
    mesh.uvs.push_back(kUvs[i]);
    mesh.tangents.push_back(glm::vec4(along, 1));
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

// A rectangle about `center` that spans 2 u x 2 v and faces u x v; u is the picture's right, v its top.
void add_rectangle(Mesh& mesh, const glm::vec3& center, const glm::vec3& u, const glm::vec3& v) {
  const glm::vec3 normal = glm::normalize(glm::cross(u, v));
  add_quad(mesh, {center - u - v, center + u - v, center + u + v, center - u + v}, normal, glm::normalize(u));
}

Mesh plane(const glm::vec3& size) {
  Mesh out;
  add_rectangle(out, {0, 0, 0}, {size.x / 2, 0, 0}, {0, 0, -size.z / 2});
  return out;
}

Mesh box(const glm::vec3& size) {
  Mesh out;
  const glm::vec3 x(size.x / 2, 0, 0), y(0, size.y / 2, 0), z(0, 0, size.z / 2);
  add_rectangle(out, z, x, y);
  add_rectangle(out, -z, -x, y);
  add_rectangle(out, x, -z, y);
  add_rectangle(out, -x, z, y);
  add_rectangle(out, y, x, -z);
  add_rectangle(out, -y, x, z);
  return out;
}

// Radius 1 in the plane y = 0, facing +y; the texture as seen from above with -z at its top.
Mesh disk(int segments) {
  Mesh out;
  const auto add = [&](double x, double z) {
    out.positions.emplace_back(x, 0, z);
    out.normals.emplace_back(0, 1, 0);
    out.uvs.emplace_back(0.5 + 0.5 * x, 0.5 + 0.5 * z);
    out.tangents.emplace_back(1, 0, 0, 1);
  };
  add(0, 0);
  for (int i = 0; i < segments; ++i) {
    const double turn = 2 * std::numbers::pi * i / segments;
    add(std::cos(turn), -std::sin(turn));
  }
  const auto count = static_cast<Index>(segments);
  for (Index i = 0; i < count; ++i) out.triangles.push_back({0, 1 + i, 1 + (i + 1) % count});
  return out;
}

// The unit sphere of `segments` around and half as many from pole to pole; u runs eastwards from -x over +z, v from the
// north pole (+y) down.
Mesh faceted_sphere(int segments) {
  Mesh out;
  const int rows = std::max(segments / 2, 2);
  for (int r = 0; r <= rows; ++r)
    for (int s = 0; s <= segments; ++s) {
      const double theta = std::numbers::pi * r / rows, phi = 2 * std::numbers::pi * s / segments;
      const glm::vec3 n(-std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      out.positions.push_back(n);
      out.normals.push_back(n);
      out.uvs.emplace_back(static_cast<double>(s) / segments, static_cast<double>(r) / rows);
      out.tangents.emplace_back(std::sin(phi), 0, std::cos(phi), 1);
    }
  const auto at = [&](int r, int s) { return static_cast<Index>(r * (segments + 1) + s); };
  for (int r = 0; r < rows; ++r)
    for (int s = 0; s < segments; ++s) {
      if (r > 0) out.triangles.push_back({at(r, s), at(r + 1, s), at(r, s + 1)});
      if (r < rows - 1) out.triangles.push_back({at(r, s + 1), at(r + 1, s), at(r + 1, s + 1)});
    }
  return out;
}

}  // namespace

Mesh shape_mesh(const std::string& shape, const glm::dvec3& size, int segments) {
  if (shape == "plane") return plane(size);
  if (shape == "box") return box(size);
  if (shape == "disk") return disk(segments);
  if (shape == "faceted_sphere") return faceted_sphere(segments);
  Mesh out;
  out.is_sphere = true;
  return out;
}

}  // namespace likeness::scene
