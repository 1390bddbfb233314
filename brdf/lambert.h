#pragma once

#include <array>
#include <numbers>

#include "brdf/geometry.h"
#include "brdf/parameter.h"
#include "brdf/promises.h"
#include "brdf/sampling.h"

namespace likeness::brdf {

// Ideal diffuse reflection, f(l, v) = rho / pi [1/sr], cosine not included.
//
// Source      Lambert 1760, Photometria.
// Directions  unit, both leaving the surface. If either is at or below the horizon, f = 0.
// Holds       f(l, v) = f(v, l); albedo = base_color.
template <Scalar S>
struct Lambert {
  static constexpr std::string_view kName = "lambert";
  static constexpr std::string_view kText = "perfectly diffuse reflection, rho / pi";
  static constexpr Promises kPromises{.reciprocal = true, .energy = Energy::kBaseColor};
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "base_color", .initial = 0.5, .range = {0, 1}, .typical = {0.02, 0.9},
                .role = Role::kScale, .channels = 3, .text = "diffuse albedo rho, linear RGB"},
  };
  // clang-format on
  static constexpr auto members() { return std::tuple{&Lambert::base_color}; }
  Rgb<S> base_color{S(kParameters[0].initial)};

  template <Scalar T>
  Rgb<S> eval(const Geometry<T>& g) const {
    const T weight = pick(g.above, constant<T>(std::numbers::inv_pi), T(0));
    return base_color * weight;
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
