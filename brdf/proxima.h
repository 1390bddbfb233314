#pragma once

#include <array>
#include <numbers>

#include "brdf/geometry.h"
#include "brdf/parameter.h"
#include "brdf/promises.h"
#include "brdf/sampling.h"

namespace likeness::brdf {

// 1 - sqrt(cos_k), [0, 1], with cos_k = clamp(-V.L): 1 while light and view are less than 90 degrees apart, 0 where they
// are opposite. Takes V.L and 1 + V.L = 2 cos^2 theta_d: written as (1 - cos_k) / (1 + sqrt(cos_k)), because it is
// divided by a cosine that vanishes together with it. Its slope in cos_k is infinite at 0, where it is taken as 0.
template <Scalar T>
T proxima_turn(const T& cos_vl, const T& one_plus_cos_vl) {
  const auto behind = greater(T(0), cos_vl);
  return pick(behind, T(one_plus_cos_vl / (T(1) + safe_sqrt(positive(T(-cos_vl))))), T(1));
}
template <Scalar T>
T proxima_turn(const Geometry<T>& g) {
  return proxima_turn(g.cos_vl, T(T(2) * g.cos_d * g.cos_d));
}

// What Proxima makes of Lambert's 1: alpha (-0.55 + 0.19 / cos_i) turn + 1. Needs cos_i >= 0; finite at 0, because the
// denominator is kept above 1e-18, in every scalar. At least 1 - 0.36 alpha, so never negative for alpha in [0, 1].
template <Scalar S, Scalar T>
S proxima_factor(const S& alpha, const T& cos_i, const T& turn) {
  const T rise = constant<T>(0.19) / larger(cos_i, constant<T>(1e-18)) - constant<T>(0.55);
  return S(1) + alpha * T(rise * turn);
}
// The same times cos_i, without a division: alpha (0.19 - 0.55 cos_i) turn + cos_i.
template <Scalar S, Scalar T>
S proxima_factor_cos(const S& alpha, const T& cos_i, const T& turn) {
  return cos_i + alpha * T((constant<T>(0.19) - constant<T>(0.55) * cos_i) * turn);
}

// Every direction alike, 1 / (2 pi): what samples the part of Proxima that does not fade towards the light's horizon. By
// the cosine alone the weights grow without bound there, and so does their variance.
template <Scalar S>
struct HemisphereLobe {
  Vec3<S> light(const Vec3<S>&, const S& u, const S& v) const {
    const S z = larger(u, constant<S>(kTiny<S>)), r = sqrt(S((S(1) - z) * (S(1) + z)));
    const S phi = constant<S>(2 * std::numbers::pi) * v;
    return {r * cos(phi), r * sin(phi), z};
  }
  S density(const Geometry<S>&) const { return constant<S>(0.5 * std::numbers::inv_pi); }
};

// Proxima: the diffuse of a surface whose GGX microfacets are Lambertian, as a function; brighter than Lambert where the
// light grazes, darker where it does not.
//
//     f(l, v) = rho / pi (alpha (-0.55 + 0.19 / cos_i) (1 - sqrt(cos_k)) + 1)        [1/sr]
//     cos_k   = clamp(-l . v) to [0, 1]
//
// Source      Jimenez and Petersen, "The Rendering of The Callisto Protocol", SIGGRAPH 2023 Advances: a fit to the
//             microfacet integral of Heitz 2014 with G2 = 1, made at view = normal.
// Departures  none in eval. eval_cos is f cos_i, multiplied through as the slide advises.
// Frame       local: z along the shading normal.
// Directions  unit, both leaving the surface. If either is at or below the horizon, f = 0.
// Holds       at alpha 0 it is Lambert, to the last bit. f >= rho / pi (1 - 0.36 alpha): the bracket is negative above
//             cos_i = 0.345, and would win only beyond alpha = 2.7.
// Does not    hold f(l, v) = f(v, l): it reads the light's cosine only. Nor does f cos_i fade at the light's horizon,
//             where it ends at 0.19 rho alpha / pi (1 - sqrt(cos_k)) and falls to 0.
template <Scalar S>
struct Proxima {
  static constexpr std::string_view kName = "proxima";
  static constexpr std::string_view kText = "diffuse of Lambertian GGX microfacets as a function of two cosines";
  static constexpr Promises kPromises{.reciprocal = false, .energy = Energy::kAtMostOne, .fades = false};
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "base_color", .initial = 0.5, .range = {0, 1}, .typical = {0.02, 0.9},
                .role = Role::kScale, .channels = 3, .text = "rho: albedo of the microfacets, linear RGB"},
      Parameter{.name = "alpha", .initial = 0.25, .range = {0, 1}, .typical = {0.01, 0.9},
                .text = "GGX alpha of their normals, which is roughness^2; 0 is Lambert"},
  };
  // clang-format on
  static constexpr auto members() { return std::tuple{&Proxima::base_color, &Proxima::alpha}; }
  Rgb<S> base_color{S(kParameters[0].initial)};
  S alpha = S(kParameters[1].initial);

  template <Scalar T>
  Rgb<S> eval(const Geometry<T>& g) const {
    return eval_at(lit_cosine(g), proxima_turn(g));
  }
  // f cos_i, [1/sr].
  template <Scalar T>
  Rgb<S> eval_cos(const Geometry<T>& g) const {
    return eval_cos_at(lit_cosine(g), proxima_turn(g));
  }
  Rgb<S> eval(const Vec3<S>& to_light, const Vec3<S>& to_view) const { return eval(Geometry<S>(to_light, to_view)); }
  Rgb<S> eval_cos(const Vec3<S>& to_light, const Vec3<S>& to_view) const {
    return eval_cos(Geometry<S>(to_light, to_view));
  }

  // The same from the light's cosine and proxima_turn; 0 where cos_i is not above 0.
  template <Scalar T>
  Rgb<S> eval_at(const T& cos_i, const T& turn) const {
    return base_color * S(proxima_factor(alpha, cos_i, turn) * weight(cos_i));
  }
  template <Scalar T>
  Rgb<S> eval_cos_at(const T& cos_i, const T& turn) const {
    return base_color * S(proxima_factor_cos(alpha, cos_i, turn) * weight(cos_i));
  }

  // The two parts of f cos_i towards a viewer along the normal, by what they reflect.
  Mixture<S, CosineLobe<S>, HemisphereLobe<S>> lobes(const Vec3<S>&) const {
    return Mixture<S, CosineLobe<S>, HemisphereLobe<S>>({S(1) - constant<S>(0.55) * alpha, constant<S>(0.38) * alpha},
                                                        {}, {});
  }
  Sample<S> sample(const Vec3<S>& to_view, const S& choice, const S& u, const S& v) const {
    return sample_lobes(*this, to_view, choice, u, v);
  }
  S pdf(const Vec3<S>& to_light, const Vec3<S>& to_view) const {
    return lobes_pdf(lobes(to_view), Geometry<S>(to_light, to_view));
  }

 private:
  template <Scalar T>
  static T lit_cosine(const Geometry<T>& g) {
    return pick(g.above, g.cos_i, T(0));
  }
  template <Scalar T>
  static T weight(const T& cos_i) {
    return pick(greater(cos_i, T(0)), constant<T>(std::numbers::inv_pi), T(0));
  }
};

}  // namespace likeness::brdf
