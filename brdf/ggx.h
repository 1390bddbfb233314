#pragma once

#include <array>
#include <numbers>

#include "brdf/geometry.h"
#include "brdf/parameter.h"

namespace likeness::brdf {

// The slope roughness that a roughness stands for: roughness^2, kept above 1e-4, where the peak of D
// (1 / (pi alpha^2) = 3.2e7) and V together are still far from the largest float.
template <Scalar S>
S alpha_of_roughness(const S& roughness) {
  return larger(S(roughness * roughness), constant<S>(1e-4));
}

// GGX distribution of normals D(h), [1/sr], isotropic: alpha^2 / (pi (sin^2 + alpha^2 cos^2)^2). With
// sin^2 from the half vector's own components the peak keeps its digits in float at alpha = 1e-4.
// Source  Walter 2007 eq. 33, written in sin^2 and cos^2. Holds: integral of D cos = 1.
template <Scalar S, Scalar T>
S ggx_distribution(const S& alpha, const T& cos_h, const T& sin2_h) {
  const S alpha2 = alpha * alpha;
  const S e = alpha2 * T(cos_h * cos_h) + sin2_h;
  return alpha2 / (e * e * constant<T>(std::numbers::pi));
}

// G2 / (4 cos_i cos_o), [1], height-correlated Smith: 1 / (2 (cos_o s(cos_i) + cos_i s(cos_o))) with
// s(c) = sqrt(alpha^2 + (1 - alpha^2) c^2). Finite for any cosines, because the denominator is kept above kTiny.
// Source  Heitz 2014 (JCGT 3(2)) eq. 99 with Lambda of eq. 72, multiplied through by the cosines.
template <Scalar S, Scalar T>
S ggx_visibility(const S& alpha, const T& cos_i, const T& cos_o) {
  const S alpha2 = alpha * alpha, rest = S(1) - alpha2;
  const S s_i = sqrt(S(alpha2 + rest * T(cos_i * cos_i)));
  const S s_o = sqrt(S(alpha2 + rest * T(cos_o * cos_o)));
  return S(0.5) / larger(S(s_i * cos_o + s_o * cos_i), constant<S>(kTiny<S>));
}

// Schlick's weight of the rise to white, (1 - cos_d)^5, from 1 - cos_d.
// Source  Schlick 1994 eq. 15: F = f0 + (1 - f0) (1 - cos_d)^5.
template <Scalar T>
T schlick_weight(const T& versine_d) {
  return fifth_power(versine_d);
}

// GGX reflection lobe, isotropic, height-correlated Smith, Schlick Fresnel:
//
//     f(l, v) = F(theta_d) D(h) G2(l, v) / (4 cos_i cos_o)     [1/sr], cosine not included
//
// Directions  unit, both leaving the surface. If either is at or below the horizon, f = 0.
// Holds       f(l, v) = f(v, l).
// Does not    scatter more than once, so a white furnace darkens as roughness grows.
template <Scalar S>
struct Ggx {
  static constexpr std::string_view kName = "ggx";
  static constexpr std::string_view kText = "one GGX lobe of microfacets with Schlick Fresnel";
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "f0", .initial = 0.04, .range = {0, 1}, .typical = {0.02, 0.9},
                .role = Role::kScale, .channels = 3, .text = "reflectance at normal incidence, linear RGB"},
      Parameter{.name = "roughness", .initial = 0.5, .range = {0, 1}, .typical = {0.05, 0.9},
                .text = "square root of the slope roughness alpha; alpha is kept above 1e-4"},
  };
  // clang-format on
  static constexpr auto members() { return std::tuple{&Ggx::f0, &Ggx::roughness}; }
  Rgb<S> f0{constant<S>(kParameters[0].initial)};
  S roughness = S(kParameters[1].initial);  // not braces: they would pick a batch's list of lanes

  template <Scalar T>
  Rgb<S> eval(const Geometry<T>& g) const {
    const T cos_i = pick(g.above, g.cos_i, T(1)), cos_o = pick(g.above, g.cos_o, T(1));
    const S alpha = alpha_of_roughness(roughness);
    const S lobe =
        pick(g.above, S(ggx_distribution(alpha, g.cos_h, g.sin2_h) * ggx_visibility(alpha, cos_i, cos_o)), S(0));
    const T rise = schlick_weight(g.versine_d);
    return Rgb<S>{mix(f0.r, S(1), rise), mix(f0.g, S(1), rise), mix(f0.b, S(1), rise)} * lobe;
  }
  Rgb<S> eval(const Vec3<S>& to_light, const Vec3<S>& to_view) const { return eval(Geometry<S>(to_light, to_view)); }
};

}  // namespace likeness::brdf
