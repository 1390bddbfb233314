#pragma once

#include "brdf/ggx.h"

// The approximations of Fresnel reflectance that renderers use. All take the cosine of the angle between the light and
// the normal of the (micro)surface, theta_d of a BRDF, as `versine` = 1 - cos, which keeps its digits near the normal.
namespace likeness::brdf {

// F = f0 + (1 - f0) (1 - cos)^5, [1].
// Source  Schlick 1994 eq. 15. Holds: F in [f0, 1], F = f0 at the normal, 1 at grazing.
template <Scalar S>
S schlick(const S& f0, const S& versine) {
  return mix(f0, S(1), schlick_weight(versine));
}

// The weight of the rise to white with a falloff n in [0, 1]: t(2 - r) (1 - cos)^(5 r), r = 2 (1 - n). 0 is no rise, 0.5
// is Schlick's to the last bit, 1 is white everywhere. The same as Callisto's Terms::fresnel, bit for bit.
// Source  Jimenez and Petersen 2023, with the exponent as in the project's definition.
template <Scalar S>
S schlick_falloff_weight(const S& falloff, const S& versine) {
  const S r = S(2) * (S(1) - falloff);
  return clamp01(S(S(2) - r)) * power5(versine, r);
}
template <Scalar S>
S schlick_falloff(const S& f0, const S& falloff, const S& versine) {
  return mix(f0, S(1), schlick_falloff_weight(falloff, versine));
}

// Metals: Schlick with a dip towards grazing, of a shape that peaks at cos = 1/7 (81.8 degrees) and vanishes at both
// ends. `tint` in [0, 1] is what Schlick's value is multiplied by there:
//
//     F = Schlick(cos) - cos (1 - cos)^6 / (1/7 (6/7)^6) Schlick(1/7) (1 - tint)        kept in [0, 1]
//
// Source      Kutz, Hasan and Edmondson 2021 ("Novel aspects of the Adobe Standard Material"), which gives the term of
//             Lazanyi and Szirmay-Kalos 2005 a tint; OpenPBR 1.1, section on metals, `specular_color`.
// Departures  clamped: beyond the dip the published form is negative for small tints (below 0.03 at f0 = 0.5, 0.008 at
//             0.7, but 0.34 at 0.04: it is meant for metals).
//             Summed as f0 (1 - q) + (1 - f0) (v^5 - (6/7)^5 q) + tint Schlick(1/7) q, so that tint 1 is Schlick.
// Holds       F = f0 at the normal, 1 at grazing, tint Schlick(1/7) at cos = 1/7.
//
// What depends on the angle alone. The differences vanish at cos = 1/7: made in double, they survive rounding to float.
template <Scalar T>
struct F82Shape {
  T q, rest, rise;  // the dip, 1 at cos = 1/7; 1 - q; v^5 - (6/7)^5 q, which is below 0 from cos = 1/7 to 6/7

  F82Shape() = default;
  F82Shape(const T& cos_i, const T& versine) {
    const T v2 = versine * versine, v5 = v2 * v2 * versine;
    q = cos_i * (v5 * versine) * constant<T>(823543.0 / 46656.0);  // 7 (7/6)^6
    rest = T(1) - q;
    rise = v5 * ((T(7) * cos_i - T(1)) * (T(1) - T(7) * versine) * constant<T>(1.0 / 6));
  }
};
template <Scalar S, Scalar T>
S f82(const S& f0, const S& tint, const F82Shape<T>& shape) {
  const S at_edge = mix(f0, S(1), constant<T>(7776.0 / 16807.0));  // Schlick at cos = 1/7
  return clamp01(S(f0 * shape.rest + (S(1) - f0) * shape.rise + tint * at_edge * shape.q));
}

}  // namespace likeness::brdf
