#pragma once

#include <array>
#include <numbers>

#include "brdf/geometry.h"
#include "brdf/parameter.h"
#include "brdf/promises.h"
#include "brdf/sampling.h"

namespace likeness::brdf {

// s of both forms of Oren and Nayar: sin theta_i sin theta_o cos(phi_i - phi_o), the product of the directions' parts in
// the surface, [-1, 1]. Along the normal, where the azimuth is undefined, it is 0. No sine, no azimuth, no branch.
template <Scalar T>
T in_surface_product(const Geometry<T>& g) {
  return g.cos_vl - g.cos_i * g.cos_o;
}

// s / max(cos_i, cos_o), [0, inf): what [1] writes as max(0, cos phi) sin(alpha) tan(beta), alpha and beta the larger and
// the smaller of the two angles to the normal. Finite for any cosines, because the denominator is kept above
// 1e-18, in every scalar.
template <Scalar T>
T towards_light(const Geometry<T>& g, const T& s) {
  return positive(s) / larger(larger(g.cos_i, g.cos_o), constant<T>(1e-18));
}

// Rough diffuse surfaces of Lambertian facets, in the form that Fujii made of Oren and Nayar's: brighter towards the
// light, flatter on a sphere, without the dark ring of the 1994 form.
//
//     f(l, v) = rho (1 + sigma s / t) / (pi + (pi / 2 - 2 / 3) sigma)                [1/sr]
//     s = l . v - cos_i cos_o,   t = max(cos_i, cos_o) where s > 0, 1 elsewhere
//
// Source      Fujii, "A tiny improvement of Oren-Nayar reflectance model", 2012: the second of its two ways to choose
//             A and B, in which sigma is the weight of the term that is not Lambert's against the one that is. It is no
//             angle: 0 is Lambert, 1 the roughest. (The first way fits A and B to the full model of 1994 by a sigma in
//             radians, and reflects more than it receives above rho = 0.97.)
// Departures  the same formula; where s < 0 written as a sum of positive terms, 1 + s = 2 cos^2 theta_d - cos_i cos_o,
//             which keeps its digits where f falls to 0 (sigma 1, opposite directions in the surface).
// Frame       local: z along the shading normal.
// Directions  unit, both leaving the surface. If either is at or below the horizon, f = 0.
// Holds       f(l, v) = f(v, l); the albedo is at most base_color and reaches it at grazing view.
// Does not    stay bounded where light and view are both grazing on the same side: f cos does.
template <Scalar S>
struct OrenNayar {
  static constexpr std::string_view kName = "oren_nayar";
  static constexpr std::string_view kText = "rough diffuse of Lambertian facets: Oren and Nayar improved by Fujii 2012";
  static constexpr Promises kPromises{.reciprocal = true, .energy = Energy::kAtMostOne};
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "base_color", .initial = 0.5, .range = {0, 1}, .typical = {0.02, 0.9},
                .role = Role::kScale, .channels = 3, .text = "rho: albedo at grazing view, linear RGB"},
      Parameter{.name = "sigma", .initial = 0.5, .range = {0, 1}, .typical = {0.05, 0.95},
                .text = "0 Lambert, 1 roughest: a weight, not an angle"},
  };
  // clang-format on
  static constexpr auto members() { return std::tuple{&OrenNayar::base_color, &OrenNayar::sigma}; }
  Rgb<S> base_color{S(kParameters[0].initial)};
  S sigma = S(kParameters[1].initial);

  template <Scalar T>
  Rgb<S> eval(const Geometry<T>& g) const {
    const T s = in_surface_product(g);
    const T away = T(2) * g.cos_d * g.cos_d - g.cos_i * g.cos_o;
    const T rough = pick(greater(s, T(0)), T(T(1) + towards_light(g, s)), away);
    const S least = constant<S>(std::numbers::pi) + constant<S>(std::numbers::pi / 2 - 2.0 / 3) * sigma;
    const S f = (S(1) - sigma + sigma * rough) / least;
    return base_color * S(pick(g.above, f, S(0)));
  }
  Rgb<S> eval(const Vec3<S>& to_light, const Vec3<S>& to_view) const { return eval(Geometry<S>(to_light, to_view)); }

  CosineLobe<S> lobes(const Vec3<S>&) const { return {}; }
  Sample<S> sample(const Vec3<S>& to_view, const S& choice, const S& u, const S& v) const {
    return sample_lobes(*this, to_view, choice, u, v);
  }
  S pdf(const Vec3<S>& to_light, const Vec3<S>& to_view) const {
    return lobes_pdf(lobes(to_view), Geometry<S>(to_light, to_view));
  }
};

// The same surfaces in the simple form of the 1994 paper, which its authors call qualitative: no interreflection, and
// Lambert's constant wherever light and view are on different sides of the normal.
//
//     f(l, v) = rho / pi (A + B max(0, cos(phi_i - phi_o)) sin(alpha) tan(beta))     [1/sr]
//     A = 1 - 0.5 sigma^2 / (sigma^2 + 0.33),   B = 0.45 sigma^2 / (sigma^2 + 0.09)
//
// alpha = max(theta_i, theta_o), beta = min(theta_i, theta_o).
//
// Source      Oren and Nayar, "Generalization of Lambert's Reflectance Model", SIGGRAPH 1994, its qualitative model.
// Departures  the same formula with dot products for angles: sin(alpha) tan(beta) cos phi = s / max(cos_i, cos_o).
// Frame       local: z along the shading normal.
// Directions  unit, both leaving the surface. If either is at or below the horizon, f = 0.
// Holds       f(l, v) = f(v, l); at sigma 0 it is Lambert.
// Does not    conserve energy: near sigma 0.2 the albedo at grazing view is 1.015 rho. Very rough it is little more than
//             half of rho, for what facets throw at one another is lost. Not bounded where both directions are grazing.
template <Scalar S>
struct OrenNayar1994 {
  static constexpr std::string_view kName = "oren_nayar_1994";
  static constexpr std::string_view kText =
      "rough diffuse of Lambertian facets: the qualitative form of Oren and Nayar";
  static constexpr Promises kPromises{.reciprocal = true, .energy = Energy::kUnbounded};
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "base_color", .initial = 0.5, .range = {0, 1}, .typical = {0.02, 0.9},
                .role = Role::kScale, .channels = 3, .text = "rho: albedo of the facets, linear RGB"},
      Parameter{.name = "sigma", .initial = 0.5, .range = {0, std::numbers::pi / 2}, .typical = {0.05, 1}, .unit = "rad",
                .text = "standard deviation of the angle by which facets are tilted"},
  };
  // clang-format on
  static constexpr auto members() { return std::tuple{&OrenNayar1994::base_color, &OrenNayar1994::sigma}; }
  Rgb<S> base_color{S(kParameters[0].initial)};
  S sigma = S(kParameters[1].initial);

  template <Scalar T>
  Rgb<S> eval(const Geometry<T>& g) const {
    const S variance = sigma * sigma;
    const S a = S(1) - S(0.5) * variance / (variance + constant<S>(0.33));
    const S b = constant<S>(0.45) * variance / (variance + constant<S>(0.09));
    const S f = (a + b * towards_light(g, in_surface_product(g))) * constant<S>(std::numbers::inv_pi);
    return base_color * S(pick(g.above, f, S(0)));
  }
  Rgb<S> eval(const Vec3<S>& to_light, const Vec3<S>& to_view) const { return eval(Geometry<S>(to_light, to_view)); }

  CosineLobe<S> lobes(const Vec3<S>&) const { return {}; }
  Sample<S> sample(const Vec3<S>& to_view, const S& choice, const S& u, const S& v) const {
    return sample_lobes(*this, to_view, choice, u, v);
  }
  S pdf(const Vec3<S>& to_light, const Vec3<S>& to_view) const {
    return lobes_pdf(lobes(to_view), Geometry<S>(to_light, to_view));
  }
};

}  // namespace likeness::brdf
