#include "render/scene/mend.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace likeness::scene {
namespace {

constexpr double kThinnest = 1e-8;  // height over longest edge of a triangle that is kept: below float's 6e-8
constexpr float kFarthestUv = 1e6f;

bool is_sound(const glm::vec3& p) {
  return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;  // false for NaN
}

// Twice the area over the longest edge squared [1].
double slenderness(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 u = b - a, v = c - a, w = c - b;
  const double longest2 = std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(w, w)});
  return longest2 > 0 ? glm::length(glm::cross(u, v)) / longest2 : 0;
}

void drop_triangles(Mesh& mesh, const std::string& where, Loading& loading) {
  std::size_t bent = 0, far = 0, thin = 0, kept = 0;
  const auto count = static_cast<Index>(mesh.positions.size());
  for (const auto& t : mesh.triangles) {
    const auto [a, b, c] = t;
    if (a >= count || b >= count || c >= count || a == b || b == c || c == a) {
      ++bent;
      continue;
    }
    const glm::vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    if (!is_sound(p) || !is_sound(q) || !is_sound(r)) ++far;
    else if (!(slenderness(p, q, r) > kThinnest)) ++thin;
    else mesh.triangles[kept++] = t;
  }
  mesh.triangles.resize(kept);
  if (bent) loading.repair("triangles with a repeated or absent corner left out", where, bent);
  if (far) loading.repair("triangles with a corner that is no number, or beyond 1e9 m, left out", where, far);
  if (thin) loading.repair("triangles without area left out", where, thin);
}

void mend_positions(Mesh& mesh, const std::string& where, Loading& loading) {
  glm::vec3 sound(0);
  for (const glm::vec3& p : mesh.positions)
    if (is_sound(p)) {
      sound = p;
      break;
    }
  std::size_t count = 0;
  for (glm::vec3& p : mesh.positions)
    if (!is_sound(p)) {
      p = sound;
      ++count;
    }
  if (count) loading.repair("vertices that are no numbers, or beyond 1e9 m, taken out", where, count);
}

// The angles of a triangle at its corners [rad].
std::array<float, 3> corner_angles(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const auto angle = [](const glm::dvec3& u, const glm::dvec3& v) {
    return static_cast<float>(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)));
  };
  const glm::dvec3 ab = glm::dvec3(b) - glm::dvec3(a), ac = glm::dvec3(c) - glm::dvec3(a),
                   bc = glm::dvec3(c) - glm::dvec3(b);
  return {angle(ab, ac), angle(-ab, bc), angle(-ac, -bc)};
}

glm::vec3 unit_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return glm::vec3(glm::normalize(glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a))));
}

// The length of a sum of vectors is that of its square, which a float may not hold.
float length_of(const glm::vec3& v) { return static_cast<float>(glm::length(glm::dvec3(v))); }

std::vector<glm::vec3> smooth_normals(const Mesh& mesh) {
  std::vector<glm::vec3> sums(mesh.positions.size(), glm::vec3(0));
  for (const auto& t : mesh.triangles) {
    const glm::vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const glm::vec3 normal = unit_normal(a, b, c);
    const std::array<float, 3> angles = corner_angles(a, b, c);
    for (std::size_t i = 0; i < 3; ++i) sums[t[i]] += angles[i] * normal;
  }
  for (glm::vec3& n : sums) {
    const float length = length_of(n);
    n = length > 1e-6f ? n / length : glm::vec3(0, 1, 0);
  }
  return sums;
}

void mend_normals(Mesh& mesh, const std::string& where, Loading& loading) {
  std::vector<Index> lost;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    glm::vec3& n = mesh.normals[i];
    const float length = length_of(n);
    if (length > 1e-12f && std::isfinite(length)) n /= length;
    else lost.push_back(static_cast<Index>(i));
  }
  if (lost.empty()) return;
  const std::vector<glm::vec3> smooth = smooth_normals(mesh);
  for (const Index i : lost) mesh.normals[i] = smooth[i];
  loading.repair("normals without a direction made from their triangles", where, lost.size());
}

// Any unit vector square to the unit vector n.
glm::vec3 square_to(const glm::vec3& n) {
  const glm::vec3 axis = std::abs(n.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  return glm::normalize(axis - n * glm::dot(n, axis));
}

bool square_up(glm::vec4& tangent, const glm::vec3& normal) {
  const glm::vec3 t(tangent);
  if (!(length_of(t) > 1e-12f) || !std::isfinite(length_of(t))) return false;
  const glm::vec3 unit = t / length_of(t), square = unit - normal * glm::dot(normal, unit);
  if (!(length_of(square) > 1e-4f)) return false;
  tangent = glm::vec4(square / length_of(square), tangent.w < 0 ? -1.0f : 1.0f);
  return true;
}

void mend_tangents(Mesh& mesh, const std::string& where, Loading& loading) {
  if (mesh.tangents.empty()) return;
  std::size_t lost = 0;
  if (mesh.normals.size() != mesh.tangents.size()) lost = mesh.tangents.size();
  else
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) lost += !square_up(mesh.tangents[i], mesh.normals[i]);
  if (lost == 0) return;
  mesh.tangents = {};
  loading.repair("tangents without a direction: all of the mesh are made anew where they are needed", where, lost);
}

}  // namespace

void mend(Mesh& mesh, Normals normals, const std::string& where, Loading& loading) {
  if (mesh.is_sphere) return;
  const std::size_t count = mesh.positions.size();
  // A reader gives one for each position or none; anything else is as good as none.
  if (mesh.normals.size() != count) mesh.normals = {};
  if (mesh.uvs.size() != count) mesh.uvs = {};
  if (mesh.tangents.size() != count) mesh.tangents = {};

  drop_triangles(mesh, where, loading);
  mend_positions(mesh, where, loading);
  if (normals == Normals::kFlat) mesh.normals = {};
  else if (normals == Normals::kSmooth) mesh.normals = smooth_normals(mesh);
  else mend_normals(mesh, where, loading);
  std::size_t lost = 0;
  for (glm::vec2& uv : mesh.uvs)
    if (!(std::abs(uv.x) <= kFarthestUv && std::abs(uv.y) <= kFarthestUv)) {
      uv = {0, 0};
      ++lost;
    }
  if (lost) loading.repair("texture coordinates that are no numbers, or beyond 1e6, made 0", where, lost);
  mend_tangents(mesh, where, loading);
}

void make_tangents(Mesh& mesh, const std::string& where, Loading& loading) {
  std::vector<glm::vec3> along(mesh.positions.size(), glm::vec3(0));
  std::vector<float> side(mesh.positions.size(), 0.0f);
  for (const auto& t : mesh.triangles) {
    const glm::vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const glm::dvec2 p = mesh.uvs[t[0]], q = glm::dvec2(mesh.uvs[t[1]]) - p, r = glm::dvec2(mesh.uvs[t[2]]) - p;
    const double area = q.x * r.y - r.x * q.y;  // of the triangle in the texture, twice and with its sign
    if (area == 0) continue;
    const glm::dvec3 u = (glm::dvec3(b - a) * r.y - glm::dvec3(c - a) * q.y) * (area > 0 ? 1.0 : -1.0);
    const double length = glm::length(u);
    if (!(length > 0)) continue;
    const std::array<float, 3> angles = corner_angles(a, b, c);
    const glm::vec3 normal = mesh.normals.empty() ? glm::vec3(0) : unit_normal(a, b, c);
    for (std::size_t i = 0; i < 3; ++i) {
      along[t[i]] += angles[i] * glm::vec3(u / length);
      // Where area > 0, v goes to the side of cross(normal, tangent), so -v is on the other: w = -1. Around a vertex
      // normal that is turned against its triangle the two change places.
      const bool is_behind = !mesh.normals.empty() && glm::dot(normal, mesh.normals[t[i]]) < 0;
      side[t[i]] += (area > 0) != is_behind ? -angles[i] : angles[i];
    }
  }
  mesh.tangents.resize(mesh.positions.size());
  std::size_t lost = 0;
  for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
    glm::vec4& tangent = mesh.tangents[i];
    tangent = glm::vec4(along[i], side[i]);
    const glm::vec3 normal = mesh.normals.empty() ? glm::vec3(0) : mesh.normals[i];
    if (square_up(tangent, normal)) continue;
    tangent = glm::vec4(square_to(mesh.normals.empty() ? glm::vec3(0, 0, 1) : normal), 1);
    ++lost;
  }
  if (lost) loading.repair("tangents where u has no direction made up", where, lost);
}

void flip_v(Mesh& mesh) {
  for (glm::vec2& uv : mesh.uvs) uv.y = 1 - uv.y;
  for (glm::vec4& tangent : mesh.tangents) tangent.w = -tangent.w;
}

}  // namespace likeness::scene
