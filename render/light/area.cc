#include "render/light/area.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "render/ray/frame.h"

namespace likeness::light {
namespace {

using std::numbers::pi_v;

// A point of a flat light as seen from `point`.
Towards towards(const glm::vec3& point, const glm::vec3& on_light, const glm::vec3& normal, float area,
                bool is_two_sided) {
  const glm::vec3 way = on_light - point;
  const float distance2 = glm::dot(way, way), distance = std::sqrt(distance2);
  if (!(distance > 0)) return {};
  const glm::vec3 direction = way / distance;
  const float facing = -glm::dot(direction, normal), cosine = is_two_sided ? std::abs(facing) : facing;
  if (!(cosine > 0)) return {};
  return {direction, distance, distance2 / (cosine * area)};
}

// The rectangle in the frame of a point, and what of it the sampling needs.
template <class R>
struct SphericalRectangle {
  using V = glm::vec<3, R>;
  V x, y, z;
  R x0, x1, y0, y1, y0_2, y1_2, z0, z0_2;
  R b0, b1, b0_2, k, solid_angle;

  SphericalRectangle(const scene::RectangleLight& light, const glm::vec3& point) {
    const V u(light.half_u), v(light.half_v);
    const R length_u = glm::length(u), length_v = glm::length(v);
    x = u / length_u, y = v / length_v, z = glm::cross(x, y);
    const V corner = V(light.center - point) - u - v;
    z0 = glm::dot(corner, z);
    if (z0 > 0) z = -z, z0 = -z0;
    x0 = glm::dot(corner, x), y0 = glm::dot(corner, y);
    x1 = x0 + 2 * length_u, y1 = y0 + 2 * length_v;
    z0_2 = z0 * z0, y0_2 = y0 * y0, y1_2 = y1 * y1;
    // Of the normals of the four planes through the point and an edge, the component that matters; n[i] belongs to the
    // edge at y0, x1, y1, x0.
    const R n0 = y0 / std::sqrt(z0_2 + y0_2), n1 = x1 / std::sqrt(z0_2 + x1 * x1);
    const R n2 = y1 / std::sqrt(z0_2 + y1_2), n3 = x0 / std::sqrt(z0_2 + x0 * x0);
    // The angles between them, within the spherical quadrilateral.
    const auto angle = [](R cosine) { return std::acos(std::clamp(cosine, R(-1), R(1))); };
    const R g0 = angle(n0 * n1), g1 = angle(-n1 * n2), g2 = angle(n2 * n3), g3 = angle(-n3 * n0);
    b0 = -n0, b1 = n2, b0_2 = b0 * b0;
    k = 2 * std::numbers::pi_v<R> - g2 - g3;
    solid_angle = g0 + g1 - k;
  }

  Towards sample(const glm::vec2& u) const {
    const R a = static_cast<R>(u.x) * solid_angle + k;
    const R fu = (std::cos(a) * b0 - b1) / std::sin(a);
    const R cu = std::clamp(std::copysign(R(1), fu) / std::sqrt(fu * fu + b0_2), R(-1), R(1));
    const R xu = std::clamp(-(cu * z0) / std::sqrt(std::max(1 - cu * cu, std::numeric_limits<R>::min())), x0, x1);
    const R d = std::sqrt(xu * xu + z0_2), h0 = y0 / std::hypot(d, y0), h1 = y1 / std::hypot(d, y1);
    const R h = h0 + static_cast<R>(u.y) * (h1 - h0), rest = (1 - h) * (1 + h);
    const R yv = rest > std::numeric_limits<R>::epsilon() ? std::clamp(h * d / std::sqrt(rest), y0, y1) : y1;
    const V way = xu * x + yv * y + z0 * z;
    const R distance = glm::length(way);
    if (!(distance > 0)) return {};
    return {glm::vec3(way / distance), static_cast<float>(distance), static_cast<float>(1 / solid_angle)};
  }
};

// The solid angle is what is left of angles that nearly make 2 pi: floats tell it to 1e-4 above this [sr].
constexpr float kLeastInFloats = 6e-3f;

float area_of(const scene::RectangleLight& light) { return 4 * glm::length(light.half_u) * glm::length(light.half_v); }
glm::vec3 normal_of(const scene::RectangleLight& light) {
  return glm::normalize(glm::cross(light.half_u, light.half_v));
}
// From so far away that all of it is seen at the same angle, by its area. A strip is far if its length is.
bool is_far(const scene::RectangleLight& light, const glm::vec3& point) {
  const glm::vec3 way = light.center - point;
  const float longest2 = std::max(glm::dot(light.half_u, light.half_u), glm::dot(light.half_v, light.half_v));
  return longest2 < 2.5e-5f * glm::dot(way, way);
}
bool is_behind(const scene::RectangleLight& light, const glm::vec3& point) {
  return !light.two_sided && glm::dot(point - light.center, normal_of(light)) <= 0;
}

}  // namespace

Towards sample_rectangle(const scene::RectangleLight& light, const glm::vec3& point, const glm::vec2& u) {
  if (is_behind(light, point)) return {};
  if (is_far(light, point)) {
    const glm::vec3 on_light = light.center + (2 * u.x - 1) * light.half_u + (2 * u.y - 1) * light.half_v;
    return towards(point, on_light, normal_of(light), area_of(light), light.two_sided);
  }
  const SphericalRectangle<float> r(light, point);
  if (r.z0 == 0) return {};
  if (r.solid_angle > kLeastInFloats) return r.sample(u);
  const SphericalRectangle<double> exact(light, point);
  return exact.solid_angle > 0 ? exact.sample(u) : Towards{};
}

float rectangle_pdf(const scene::RectangleLight& light, const glm::vec3& point, const glm::vec3& direction,
                    float distance) {
  if (is_behind(light, point)) return 0;
  if (is_far(light, point)) {
    const float cosine = std::abs(glm::dot(direction, normal_of(light)));
    return cosine > 0 ? distance * distance / (cosine * area_of(light)) : 0.0f;
  }
  const SphericalRectangle<float> r(light, point);
  if (r.z0 == 0) return 0;
  if (r.solid_angle > kLeastInFloats) return 1 / r.solid_angle;
  const SphericalRectangle<double> exact(light, point);
  return exact.solid_angle > 0 ? static_cast<float>(1 / exact.solid_angle) : 0.0f;
}

Towards sample_disk(const scene::DiskLight& light, const glm::vec3& point, const glm::vec2& u) {
  const ray::Frame frame(light.normal);
  const float radius = light.radius * std::sqrt(u.x), angle = 2 * pi_v<float> * u.y;
  const glm::vec3 on_light = light.center + radius * (std::cos(angle) * frame.x + std::sin(angle) * frame.y);
  return towards(point, on_light, light.normal, pi_v<float> * light.radius * light.radius, light.two_sided);
}
float disk_pdf(const scene::DiskLight& light, const glm::vec3&, const glm::vec3& direction, float distance) {
  const float facing = -glm::dot(direction, light.normal), cosine = light.two_sided ? std::abs(facing) : facing;
  return cosine > 0 ? distance * distance / (cosine * pi_v<float> * light.radius * light.radius) : 0.0f;
}

namespace {
// 1 - cos of half the cone's angle, without the cancellation of a sphere far away; 0: the point is inside.
float versine_of_cone(const scene::SphereLight& light, float distance2) {
  const float radius2 = light.radius * light.radius;
  if (!(distance2 > radius2)) return 0;
  const float sin2 = radius2 / distance2;
  return sin2 / (1 + std::sqrt(1 - sin2));
}
}  // namespace

Towards sample_sphere(const scene::SphereLight& light, const glm::vec3& point, const glm::vec2& u) {
  const glm::vec3 way = light.center - point;
  const float distance2 = glm::dot(way, way), versine = versine_of_cone(light, distance2);
  if (!(versine > 0)) return {};
  const float distance = std::sqrt(distance2);
  const ray::Frame frame(way / distance);
  const float v = u.x * versine, cosine = 1 - v, sine = std::sqrt(std::max(v * (2 - v), 0.0f)),
              angle = 2 * pi_v<float> * u.y;
  const glm::vec3 direction = frame.world({sine * std::cos(angle), sine * std::sin(angle), cosine});
  const float across2 = light.radius * light.radius - distance2 * sine * sine;  // of the half chord
  return {direction, distance * cosine - std::sqrt(std::max(across2, 0.0f)), 1 / (2 * pi_v<float> * versine)};
}
float sphere_pdf(const scene::SphereLight& light, const glm::vec3& point) {
  const glm::vec3 way = light.center - point;
  const float versine = versine_of_cone(light, glm::dot(way, way));
  return versine > 0 ? 1 / (2 * pi_v<float> * versine) : 0.0f;
}

}  // namespace likeness::light
