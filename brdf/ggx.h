#pragma once

#include <array>
#include <numbers>

#include "brdf/geometry.h"
#include "brdf/parameter.h"
#include "brdf/promises.h"
#include "brdf/sampling.h"

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

// GGX distribution of normals D(h), [1/sr], anisotropic. Multiplied through by alpha_x alpha_y, so that
// alpha_x = alpha_y has the bits of ggx_distribution on sin^2 = x^2 + y^2, and so that nothing is divided
// by a small alpha.
// Source  Burley 2012, appendix B.2 (GTR, gamma = 2). Holds: integral of D cos = 1.
template <Scalar S, Scalar T>
S ggx_distribution_anisotropic(const S& alpha_x, const S& alpha_y, const Vec3<T>& half, const T& cos_h) {
  const S area = alpha_x * alpha_y;
  const S across = alpha_y / alpha_x * T(half.x * half.x) + alpha_x / alpha_y * T(half.y * half.y);
  const S e = area * T(cos_h * cos_h) + across;
  return area / (e * e * constant<T>(std::numbers::pi));
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

// Smith's masking of one direction divided by 2 cos: 1 / (cos + sqrt(alpha^2 + (1 - alpha^2) cos^2)), [1].
// Two of them, light times view, are G / (4 cos_i cos_o) of uncorrelated shadowing and masking.
// Source  Walter 2007 eq. 34, divided by 2 cos.
template <Scalar S, Scalar T>
S ggx_masking(const S& alpha, const T& c) {
  const S alpha2 = alpha * alpha;
  return S(1) / (S(sqrt(S(alpha2 + (S(1) - alpha2) * T(c * c)))) + c);
}

// Schlick's weight of the rise to white, (1 - cos_d)^5, from 1 - cos_d.
// Source  Schlick 1994 eq. 15: F = f0 + (1 - f0) (1 - cos_d)^5.
template <Scalar T>
T schlick_weight(const T& versine_d) {
  return fifth_power(versine_d);
}

// 1 - cos theta_d at which an estimate of what a lobe returns to a view takes its Fresnel rise: in the mirror direction,
// and at least at 45 degrees, which a rough lobe reaches from any view.
template <Scalar S>
S usual_versine(const Vec3<S>& to_view) {
  return larger(S(S(1) - to_view.z), constant<S>(0.3));
}

// The normals that the viewer sees of a GGX surface, as a lobe to sample: density G1(v) D(h) / (4 cos_o), with
// G1(v) / (2 cos_o) = 1 / (cos_o + sqrt(cos_o^2 + alpha_x^2 x^2 + alpha_y^2 y^2)), a sum of positive terms that stays
// finite at grazing views. Directions mirrored below the horizon are lost; ggx.md says how many.
// Source  Heitz 2018 (JCGT 7(4)); the sampling is that of ggx_visible_normal.
template <Scalar S>
struct GgxLobe {
  S alpha_x, alpha_y;

  explicit GgxLobe(const S& alpha) : alpha_x(alpha), alpha_y(alpha) {}
  GgxLobe(const S& x, const S& y) : alpha_x(x), alpha_y(y) {}

  Vec3<S> light(const Vec3<S>& to_view, const S& u, const S& v) const {
    return mirrored(to_view, ggx_visible_normal(to_view, alpha_x, alpha_y, u, v));
  }
  S density(const Geometry<S>& g) const {
    const S stretched = g.cos_o * g.cos_o + squared(S(alpha_x * g.to_view.x)) + squared(S(alpha_y * g.to_view.y));
    return S(0.5) * ggx_distribution_anisotropic(alpha_x, alpha_y, g.half, g.cos_h) / (g.cos_o + S(sqrt(stretched)));
  }
};

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
  static constexpr Promises kPromises{.reciprocal = true, .energy = Energy::kAtMostOne};
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

  GgxLobe<S> lobes(const Vec3<S>&) const { return GgxLobe<S>(alpha_of_roughness(roughness)); }
  Sample<S> sample(const Vec3<S>& to_view, const S& choice, const S& u, const S& v) const {
    return sample_lobes(*this, to_view, choice, u, v);
  }
  S pdf(const Vec3<S>& to_light, const Vec3<S>& to_view) const {
    return lobes_pdf(lobes(to_view), Geometry<S>(to_light, to_view));
  }
};

}  // namespace likeness::brdf
