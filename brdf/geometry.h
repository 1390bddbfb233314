#pragma once

#include <cstddef>

#include "brdf/vector.h"

namespace likeness::brdf {

inline constexpr std::size_t kGeometryColumns = 17;  // the plain numbers of a Geometry

// A pair of directions and every angle of it that the models read, computed once and without
// cancellation: sin theta_d = |l - v| / 2 and cos theta_d = |l + v| / 2 for unit l and v, and
// 1 - cos x = sin^2 x / (1 + cos x), exact to rounding from theta = 0 to 90 degrees.
//
// Frame       local: z along the shading normal.
// Directions  unit, both leaving the surface: to_light = omega_i, to_view = omega_o.
// Half frame  Rusinkiewicz 1998 ("A New Change of Variables"): h = normalize(l + v),
//             theta_h = angle(n, h), theta_d = angle(l, h). For opposite directions, which have no h, h = n.
template <Scalar T>
struct Geometry {
  Vec3<T> to_light, to_view, half;
  T cos_i, cos_o;                           // of the light's and the viewer's angle to the normal; may be <= 0
  T cos_h, sin2_h, versine_h;               // of theta_h: cosine, squared sine, 1 - cosine
  T cos_d, versine_d;                       // of theta_d: cosine, 1 - cosine
  T cos_vl;                                 // of the angle between them, 2 theta_d: keeps its digits where it vanishes
  decltype(greater(T(0.0), T(0.0))) above;  // a mask: both directions are above the horizon

  // From directions in this precision.
  Geometry(const Vec3<T>& l, const Vec3<T>& v)
      : to_light(l),
        to_view(v),
        cos_i(l.z),
        cos_o(v.z),
        cos_vl(dot(l, v)),
        above(both(greater(l.z, T(0)), greater(v.z, T(0)))) {
    const Vec3<T> sum = l + v, difference = l - v;
    const T length2 = dot(sum, sum);
    const auto usable = greater(length2, constant<T>(kTiny<T> * kTiny<T>));
    const T length = T(sqrt(pick(usable, length2, constant<T>(kTiny<T> * kTiny<T>))));
    half = Vec3<T>{pick(usable, T(sum.x / length), T(0)), pick(usable, T(sum.y / length), T(0)),
                   pick(usable, T(sum.z / length), T(1))};
    cos_h = clamp01(half.z);
    sin2_h = half.x * half.x + half.y * half.y;
    versine_h = smaller(T(sin2_h / (T(1) + cos_h)), T(1));
    cos_d = smaller(T(length * T(0.5)), T(1));
    versine_d = smaller(T(dot(difference, difference) * T(0.25)), T(1)) / (T(1) + cos_d);
  }

  // A pair computed in double, rounded to this precision: nothing is lost to rounded directions.
  template <class U>
    requires std::constructible_from<T, U>
  explicit Geometry(const Geometry<U>& g)
      : to_light(g.to_light),
        to_view(g.to_view),
        half(g.half),
        cos_i(T(g.cos_i)),
        cos_o(T(g.cos_o)),
        cos_h(T(g.cos_h)),
        sin2_h(T(g.sin2_h)),
        versine_h(T(g.versine_h)),
        cos_d(T(g.cos_d)),
        versine_d(T(g.versine_d)),
        cos_vl(T(g.cos_vl)),
        above(g.above) {}

  // As kGeometryColumns numbers, for tables and streams, and back without loss.
  void to_columns(T* out) const {
    const T all[]{to_light.x, to_light.y, to_light.z, to_view.x, to_view.y, to_view.z, half.x,    half.y, half.z,
                  cos_i,      cos_o,      cos_h,      sin2_h,    versine_h, cos_d,     versine_d, cos_vl};
    for (std::size_t i = 0; i < kGeometryColumns; ++i) out[i] = all[i];
  }
  static Geometry from_columns(const T* in) { return Geometry(in); }

 private:
  explicit Geometry(const T* in)
      : to_light(in[0], in[1], in[2]),
        to_view(in[3], in[4], in[5]),
        half(in[6], in[7], in[8]),
        cos_i(in[9]),
        cos_o(in[10]),
        cos_h(in[11]),
        sin2_h(in[12]),
        versine_h(in[13]),
        cos_d(in[14]),
        versine_d(in[15]),
        cos_vl(in[16]),
        above(both(greater(in[9], T(0)), greater(in[10], T(0)))) {}
};

// The pair of half-angle coordinates (radians), with the half vector in the x-z plane:
// l = rotate_y(theta_h) rotate_z(phi_d) (sin theta_d, 0, cos theta_d), v its mirror about h. What depends
// on theta_h or theta_d alone is taken from the angle, so that it loses nothing near a mirror peak.
template <Scalar T>
Geometry<T> geometry_at(const T& theta_h, const T& theta_d, const T& phi_d) {
  const T sin_h = sin(theta_h), cos_h = cos(theta_h), sin_d = sin(theta_d), cos_d = cos(theta_d);
  const T x = sin_d * cos(phi_d), y = sin_d * sin(phi_d);
  Geometry<T> g(Vec3<T>{cos_h * x + sin_h * cos_d, y, cos_h * cos_d - sin_h * x},
                Vec3<T>{sin_h * cos_d - cos_h * x, -y, cos_h * cos_d + sin_h * x});
  g.half = Vec3<T>{sin_h, T(0), cos_h};
  g.cos_h = cos_h;
  g.sin2_h = sin_h * sin_h;
  g.versine_h = T(2) * squared(T(sin(T(theta_h * T(0.5)))));
  g.cos_d = cos_d;
  g.versine_d = T(2) * squared(T(sin(T(theta_d * T(0.5)))));
  g.cos_vl = cos(T(theta_d + theta_d));
  return g;
}

}  // namespace likeness::brdf
