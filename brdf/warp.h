#pragma once

#include <numbers>

#include "brdf/vector.h"

// Maps of the unit square, where random numbers live, to directions. u and v are in [0, 1), both ends of what a float can
// hold of it included. No branch on a value.
namespace likeness::brdf {

// The square onto the hemisphere about z with density cos / pi, [1/sr]: concentric squares go to circles of the disk below
// it, so that neighbours stay neighbours. The edge of the square, which low-discrepancy points start from, stays above the
// horizon: cos is at least 1e-9 in float.
// Source  Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square", lifted to the hemisphere (Malley).
template <Scalar S>
Vec3<S> cosine_hemisphere(const S& u, const S& v) {
  const S a = S(2) * u - S(1), b = S(2) * v - S(1);
  const auto wide = greater(S(a * a), S(b * b));
  const S radius = pick(wide, a, b), other = pick(wide, b, a);  // the radius has a sign: it saves two more quadrants
  const auto off_center = greater(S(radius * radius), S(0));
  const S angle = constant<S>(std::numbers::pi / 4) * (pick(off_center, other, S(0)) / pick(off_center, radius, S(1)));
  const S along = radius * cos(angle), across = radius * sin(angle);
  const S cos2 = (S(1) - radius) * (S(1) + radius);
  return {pick(wide, along, across), pick(wide, across, along), S(sqrt(larger(cos2, constant<S>(kTiny<S>))))};
}

// A normal that the viewer sees of a GGX surface with slope roughness alpha_x, alpha_y > 0, with density
// G1(v) max(0, v . h) D(h) / cos_o, [1/sr]. Needs to_view above the horizon.
//
// Scaled to alpha = 1 the normals are those of a hemisphere, and the directions that a mirror of that shape reflects the
// viewer to fill a spherical cap uniformly; so h is the half vector of the view and a point c of the cap. What would
// cancel near the pole or in float is written out: with w the scaled view, c_z + w_z = (1 - v) (1 + w_z) and
// sin^2 c = v ((1 - v) (1 + w_z)^2 + w_x^2 + w_y^2).
// Source  Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps"; the density: Heitz 2018.
template <Scalar S>
Vec3<S> ggx_visible_normal(const Vec3<S>& to_view, const S& alpha_x, const S& alpha_y, const S& u, const S& v) {
  const auto normalized = [](const Vec3<S>& a) {
    return a * S(S(1) / sqrt(larger(dot(a, a), constant<S>(kTiny<S> * kTiny<S>))));
  };
  const Vec3<S> w = normalized(Vec3<S>(S(alpha_x * to_view.x), S(alpha_y * to_view.y), to_view.z));
  const S rest = S(1) - v, reach = S(1) + w.z;
  const S sine = sqrt(S(v * (rest * reach * reach + w.x * w.x + w.y * w.y)));
  const S angle = constant<S>(2 * std::numbers::pi) * u;
  return normalized(
      Vec3<S>(S(alpha_x * (sine * cos(angle) + w.x)), S(alpha_y * (sine * sin(angle) + w.y)), S(rest * reach)));
}

// The direction that a mirror with this normal reflects `w` to; both leave the surface.
template <Scalar S>
Vec3<S> mirrored(const Vec3<S>& w, const Vec3<S>& normal) {
  return normal * S(S(2) * dot(w, normal)) - w;
}

}  // namespace likeness::brdf
