#pragma once

#include <array>
#include <numbers>

#include "brdf/ggx.h"
#include "brdf/vector.h"

// What roughness and the length of an averaged normal say of one another, and the arithmetic of the mip maps that use it.
namespace likeness::brdf {

// q(w) = (atanh(sqrt w) - sqrt w) / w^(3/2), w = 1 - alpha^2 in [0, 1]: the mean normal of GGX has the length
// 1 - alpha^2 q. From 1/3 at w = 0 it grows without end towards w = 1, as ln(2 / alpha) - 1.
template <Scalar S>
struct NormalShortening {
  S q;      // [1/3, inf)
  S slope;  // dq/dw

  // Takes w, alpha^2 = 1 - w and ln alpha, because near either end one of them has lost what another still has.
  // Up to w = 1/5 by the series q = sum of w^k / (2 k + 3), whose terms left out are below 1e-17; beyond by
  // atanh(sqrt w) = ln(1 + sqrt w) - ln alpha, where the difference costs q one digit.
  NormalShortening(const S& w, const S& alpha2, const S& log_alpha) : q(0.0), slope(0.0) {
    constexpr int kTerms = 23;
    S series = constant<S>(1.0 / (2 * kTerms + 3)), series_slope = S(0);
    for (int k = kTerms; k-- > 0;) {
      series_slope = series_slope * w + series;
      series = series * w + constant<S>(1.0 / (2 * k + 3));
    }
    const auto closed = greater(w, constant<S>(0.2));
    const S x = pick(closed, w, S(0.5)), root = sqrt(x), rest = pick(closed, alpha2, S(0.5));
    const S exact = (log1p(root) - log_alpha - root) / (x * root);
    q = pick(closed, exact, series);
    slope = pick(closed, S((S(1) / rest - S(3) * exact) / (S(2) * x)), series_slope);
  }
};

// What is missing from 1 in the length below, without the subtraction: alpha^2 q. [0, 1/3].
template <Scalar S>
S normal_deficit(const S& alpha) {
  const S a = larger(clamp01(alpha), constant<S>(kTiny<S>)), alpha2 = a * a;
  return alpha2 * NormalShortening<S>(S((S(1) - a) * (S(1) + a)), alpha2, S(log(a))).q;
}

// Mean of the normals of a GGX surface, each weighted by the part of the flat surface that it covers: the integral of
// (h . n) D(h) cos over the hemisphere. [2/3, 1], falling with alpha.
//
//     length = (s - alpha^2 atanh s) / s^3,   s = sqrt(1 - alpha^2)
//
// alpha       GGX's, [0, 1]; clamped to it. Not kept above 1e-4.
// Source      Chan, "Material Advances in Call of Duty: WWII", SIGGRAPH 2018 Advances: its macrosurface. (Its microsurface
//             weights a normal by the area of the facet itself, and ends at 1/2; a texel of a normal map stands for
//             a part of the flat surface.)
// Departures  written 1 - alpha^2 q (NormalShortening): nothing cancels at alpha 0, and at alpha 1 it is no 0 / 0.
template <Scalar S>
S normal_length(const S& alpha) {
  return S(1) - normal_deficit(alpha);
}

// alpha^2 within 7 % from a deficit in (0, 1/3], for alpha in [1e-12, 1]: the leading term of the inverse below, with one
// constant fitted. The cheap form of alpha_of_normal_deficit, and where its iteration starts.
template <Scalar S>
S alpha2_near_normal_deficit(const S& deficit) {
  const S x = S(3) * deficit;
  return x / (S(1) - constant<S>(1.7) * log(x));
}

// The inverse: alpha of GGX whose mean normal is shorter than 1 by `deficit` = 1 - length. [0, 1]; 1 at and beyond a
// deficit of 1/3, 0 at and below 0. Takes the deficit because a length near 1 has lost what tells one small alpha from
// another: in float, lengths end at alpha 1e-4. Deficits below 1e-36 (in double 1e-300) count as 0.
// Its slope is infinite at 0, where it is taken as 0.
//
// Newton's method on ln(alpha^2 q) = ln deficit, which is nearly straight: the start is within 7 % of alpha^2 (for alpha
// in [1e-12, 1]), two steps leave 1e-4 and 4e-10, a last one on alpha^2 q = deficit itself nothing. Only that one is
// taken in S, so that derivatives are those of the inverse function.
//
// kSteps: of Newton's method, 3 for rounding. With 2 alpha is off by up to 1e-9, with 1 by 2.4e-4 (relative).
template <int kSteps = 3, Scalar S>
S alpha_of_normal_deficit(const S& deficit) {
  using V = Value<S>;
  const S floor = constant<S>(kTiny<S> * kTiny<S>), third = constant<S>(1.0 / 3);
  const auto some = greater(deficit, floor), whole = greater(deficit, third);
  const S d = pick(whole, third, pick(some, deficit, third));
  const V target = Arithmetic<S>::value(d);

  const auto shortening = [](const V& alpha2) {
    return NormalShortening<V>(V(V(1) - alpha2), alpha2, V(V(0.5) * log(alpha2)));
  };
  V alpha2 = alpha2_near_normal_deficit(target);
  for (int step = 1; step < kSteps; ++step) {
    const auto at = shortening(alpha2);
    const V off = log(V(alpha2 * at.q / target));
    alpha2 = smaller(V(alpha2 * exp(V(-off / (V(1) - alpha2 * at.slope / at.q)))), V(1));
  }
  const auto at = shortening(alpha2);
  const S last = S(alpha2) + (d - S(V(alpha2 * at.q))) / S(V(at.q - alpha2 * at.slope));
  const S alpha = pick(whole, S(1), S(sqrt(larger(last, floor))));
  return pick(some, smaller(alpha, S(1)), S(0));
}

// The same from a length. What is shorter than 2/3 is as rough as GGX can be, what is longer than 1 is smooth.
template <Scalar S>
S alpha_of_normal_length(const S& length) {
  return alpha_of_normal_deficit(S(S(1) - length));
}

// ---- mip maps of normals and roughness.
//
// A texel's normal is shortened by its own roughness; shortened normals are averaged as vectors; the length of the mean
// says how rough what was averaged looks from afar, its direction which way it faces. The roughness found is the alpha of
// the specular lobe (GGX, Callisto: specular antialiasing) and of the diffuse (Proxima, microfacet_diffuse: diffuse
// antialiasing): one map serves both. Exact for the mean normal, an approximation for everything else: what is averaged
// is taken for one GGX distribution about one normal.
//
//     ShortenedNormals<double> sum;
//     for (const Texel& t : block) sum.add(t.normal, t.roughness, t.weight);
//     const FilteredNormal<double> coarse = sum.filtered();
//
// Use double: in float a mean's length is known to 6e-8, which is all there is of an alpha of 1e-4.
// Source  Chan 2018 (above); for the diffuse Jimenez and Petersen, "The Rendering of The Callisto Protocol", 2023.

template <Scalar S>
struct FilteredNormal {
  Vec3<S> normal;        // unit; the z axis where normals cancel one another
  S roughness = S(0.0);  // [0, 1]: square root of alpha
  S length = S(1.0);     // of the mean, before it was made unit; below 2/3 the normals differ by more than alpha 1 says
};

// `normal` (unit) of length normal_length(roughness^2).
template <Scalar S>
Vec3<S> shortened_normal(const Vec3<S>& normal, const S& roughness) {
  return normal * normal_length(S(roughness * roughness));
}

// The unit normal and the roughness that a mean of shortened normals stands for.
template <Scalar S>
FilteredNormal<S> filtered_normal(const Vec3<S>& mean) {
  const S length2 = dot(mean, mean);
  const auto usable = greater(length2, constant<S>(kTiny<S> * kTiny<S>));
  const S length = sqrt(pick(usable, length2, S(1)));
  FilteredNormal<S> out;
  out.normal = {pick(usable, S(mean.x / length), S(0)), pick(usable, S(mean.y / length), S(0)),
                pick(usable, S(mean.z / length), S(1))};
  out.length = pick(usable, length, S(0));
  out.roughness = safe_sqrt(alpha_of_normal_length(out.length));
  return out;
}

// A weighted mean of shortened normals.
template <Scalar S>
struct ShortenedNormals {
  Vec3<S> sum;
  S weight = S(0.0);

  void add(const Vec3<S>& normal, const S& roughness, const S& by = S(1.0)) {
    sum = sum + shortened_normal(normal, roughness) * by;
    weight = weight + by;
  }
  // Needs a weight above 0.
  FilteredNormal<S> filtered() const { return filtered_normal(Vec3<S>(sum * S(S(1) / weight))); }
};

}  // namespace likeness::brdf
