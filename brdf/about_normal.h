#pragma once

#include <cmath>
#include <variant>

#include "brdf/any_brdf.h"

namespace likeness::brdf {

// f(l, v) of a model about a unit normal n, with n and both directions in one frame: for pictures of normals, which have
// no tangents. Those are chosen here, so a model that reads them (alpha_x unlike alpha_y) is turned at random.
inline Rgb<double> eval_about(const AnyBrdf& model, const Vec3<double>& n, const Vec3<double>& to_light,
                              const Vec3<double>& to_view) {
  const Vec3<double> away = std::abs(n.z) < 0.9 ? Vec3<double>{0, 0, 1} : Vec3<double>{1, 0, 0};
  const auto cross = [](const Vec3<double>& a, const Vec3<double>& b) {
    return Vec3<double>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };
  const Vec3<double> across = cross(away, n);
  const double length = std::sqrt(dot(across, across));
  const Vec3<double> x{across.x / length, across.y / length, across.z / length}, y = cross(n, x);
  const Vec3<double> l{dot(to_light, x), dot(to_light, y), dot(to_light, n)};
  const Vec3<double> v{dot(to_view, x), dot(to_view, y), dot(to_view, n)};
  return std::visit([&](const auto& m) { return m.eval(l, v); }, model);
}

}  // namespace likeness::brdf
