#pragma once

#include <array>
#include <numbers>

#include "brdf/geometry.h"
#include "brdf/parameter.h"
#include "brdf/promises.h"
#include "brdf/sampling.h"

namespace likeness::brdf {

// Ten multiply-adds that stand for microfacet_diffuse() where that keeps energy, and stay below it where it does not:
//
//     pi f / rho = 1 + alpha (s (a + b alpha + (c + d alpha) q) - e (q - 1/2))
//     s = sin_i sin_o cos(phi),   q = cos_i^2 + cos_o^2
//
// Source      this project's. The five numbers are a least-squares fit over alpha in [0, 1] and all directions,
//             weighted by their cosines, of the relative error together with twice that of the albedo, where the
//             integral's counts as 1 above 1 (tests/brdf/diffuse/diffuse_study.cc).
// Directions  unit, both leaving the surface. If either is at or below the horizon, f = 0.
// Holds       f(l, v) = f(v, l). The albedo is base_color (1 - e alpha cos_o^2) exactly, since over the hemisphere the
//             mean of s is 0 and that of cos_i^2 is 1/2: never above base_color. pi f / rho is at least 0.15. alpha = 0
//             is Lambert.
// Does not    rise without bound towards grazing angles, as the integral does: a reciprocal model that did would
//             reflect more than it receives.
template <Scalar S>
struct MicrofacetDiffuseFit {
  static constexpr std::string_view kName = "microfacet_diffuse_fit";
  static constexpr std::string_view kText =
      "Lambertian microfacets with GGX normals: a polynomial fit that keeps energy";
  static constexpr Promises kPromises{.reciprocal = true, .energy = Energy::kAtMostOne};
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "base_color", .initial = 0.5, .range = {0, 1}, .typical = {0.02, 0.9},
                .role = Role::kScale, .channels = 3, .text = "albedo rho of each facet, linear RGB"},
      Parameter{.name = "alpha", .initial = 0.25, .range = {0, 1}, .typical = {0.01, 1},
                .text = "slope roughness of the normals, roughness^2; 0 is Lambert"},
  };
  // clang-format on
  static constexpr auto members() {
    return std::tuple{&MicrofacetDiffuseFit::base_color, &MicrofacetDiffuseFit::alpha};
  }
  Rgb<S> base_color{constant<S>(kParameters[0].initial)};
  S alpha = constant<S>(kParameters[1].initial);  // not braces: they would pick a batch's list of lanes

  // a, b, c, d, e.
  static constexpr std::array kCoefficients{2.170, -1.263, -1.246, 1.280, 0.2084};

  // [1/sr], without the cosine.
  template <Scalar T>
  Rgb<S> eval(const Geometry<T>& g) const {
    return eval_at(lit_cosine(g), side_of(g), squares_of(g));
  }
  Rgb<S> eval(const Vec3<S>& to_light, const Vec3<S>& to_view) const { return eval(Geometry<S>(to_light, to_view)); }

  // f cos_i.
  template <Scalar T>
  Rgb<S> eval_cos(const Geometry<T>& g) const {
    return eval_cos_at(lit_cosine(g), side_of(g), squares_of(g));
  }

  // The same from what they read of a pair: cos_i, 0 where either direction is at or below the horizon; s; and q.
  template <Scalar T>
  Rgb<S> eval_at(const T& cos_i, const T& s, const T& q) const {
    const T lit = pick(greater(cos_i, T(0)), constant<T>(std::numbers::inv_pi), T(0));
    return base_color * S(over_lambert(s, q) * lit);
  }
  template <Scalar T>
  Rgb<S> eval_cos_at(const T& cos_i, const T& s, const T& q) const {
    return base_color * S(over_lambert(s, q) * T(cos_i * constant<T>(std::numbers::inv_pi)));
  }
  template <Scalar T>
  static T lit_cosine(const Geometry<T>& g) {
    return pick(g.above, g.cos_i, T(0));
  }
  template <Scalar T>
  static T side_of(const Geometry<T>& g) {
    return g.to_light.x * g.to_view.x + g.to_light.y * g.to_view.y;
  }
  template <Scalar T>
  static T squares_of(const Geometry<T>& g) {
    return g.cos_i * g.cos_i + g.cos_o * g.cos_o;
  }

  // The part of the light from all around that reaches a viewer.
  Rgb<S> albedo(const S& cos_o) const {
    return base_color * S(S(1) - alpha * cos_o * cos_o * constant<S>(kCoefficients[4]));
  }

  CosineLobe<S> lobes(const Vec3<S>&) const { return {}; }
  Sample<S> sample(const Vec3<S>& to_view, const S& choice, const S& u, const S& v) const {
    return sample_lobes(*this, to_view, choice, u, v);
  }
  S pdf(const Vec3<S>& to_light, const Vec3<S>& to_view) const {
    return lobes_pdf(lobes(to_view), Geometry<S>(to_light, to_view));
  }

 private:
  // pi f / rho.
  template <Scalar T>
  S over_lambert(const T& s, const T& q) const {
    constexpr auto k = kCoefficients;
    const S slope = constant<S>(k[0]) + constant<S>(k[1]) * alpha + (constant<S>(k[2]) + constant<S>(k[3]) * alpha) * q;
    const T level = constant<T>(k[4]) * (T(0.5) - q);
    return S(1) + alpha * (slope * s + level);
  }
};

}  // namespace likeness::brdf
