#pragma once

#include <array>
#include <numbers>

#include "brdf/geometry.h"
#include "brdf/parameter.h"
#include "brdf/promises.h"
#include "brdf/sampling.h"

namespace likeness::brdf {

// The rise (or fall) of a diffuse lobe towards grazing light and grazing view, [1]:
//
//     (1 + (at_grazing - 1) (1 - cos_i)^5) (1 + (at_grazing - 1) (1 - cos_o)^5)
//
// at_grazing = 1 is Lambert's constant. Never negative for at_grazing >= 0.
template <Scalar S, Scalar T>
S burley_grazing(const S& at_grazing, const T& cos_i, const T& cos_o) {
  const S change = at_grazing - S(1);
  return (S(1) + change * fifth_power(T(T(1) - cos_i))) * (S(1) + change * fifth_power(T(T(1) - cos_o)));
}

// F_D90, the value of that rise at 90 degrees: half for a smooth surface, a retroreflective 2.5 for a rough one.
template <Scalar S, Scalar T>
S burley_at_grazing(const S& roughness, const T& cos_d) {
  return S(0.5) + S(2) * roughness * T(cos_d * cos_d);
}

// Burley's diffuse lobe: darker than Lambert at grazing angles when smooth, retroreflective when rough.
//
//     f(l, v) = rho / pi (1 + (F_D90 - 1) (1 - cos_i)^5) (1 + (F_D90 - 1) (1 - cos_o)^5)     [1/sr]
//     F_D90   = 0.5 + 2 roughness cos^2 theta_d
//
// Source      Burley, "Physically-Based Shading at Disney", SIGGRAPH 2012 course, section 5.3 (diffuse).
// Frame       local: z along the shading normal.
// Directions  unit, both leaving the surface. If either is at or below the horizon, f = 0.
// Holds       f(l, v) = f(v, l).
// Does not    conserve energy: at base_color 1 and roughness 1 the albedo is 1.04 at normal view and 1.54 at grazing.
template <Scalar S>
struct BurleyDiffuse {
  static constexpr std::string_view kName = "burley_diffuse";
  static constexpr std::string_view kText = "diffuse of Burley 2012, with a retroreflective rise by roughness";
  static constexpr Promises kPromises{.reciprocal = true, .energy = Energy::kUnbounded};
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "base_color", .initial = 0.5, .range = {0, 1}, .typical = {0.02, 0.9},
                .role = Role::kScale, .channels = 3, .text = "rho: reflectance scale, linear RGB"},
      Parameter{.name = "roughness", .initial = 0.5, .range = {0, 1}, .typical = {0.05, 0.95},
                .text = "0 darkens towards grazing angles, 1 brightens towards the light"},
  };
  // clang-format on
  static constexpr auto members() { return std::tuple{&BurleyDiffuse::base_color, &BurleyDiffuse::roughness}; }
  Rgb<S> base_color{S(kParameters[0].initial)};
  S roughness = S(kParameters[1].initial);

  template <Scalar T>
  Rgb<S> eval(const Geometry<T>& g) const {
    const T weight = pick(g.above, constant<T>(std::numbers::inv_pi), T(0));
    return base_color * S(burley_grazing(burley_at_grazing(roughness, g.cos_d), g.cos_i, g.cos_o) * weight);
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
