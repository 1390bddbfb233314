#pragma once

#include <numbers>

#include "brdf/scalar.h"

// Burley's normalised diffusion: how much of the light that enters a flat surface at one point leaves it at distance r.
//
//     R(r) = A s (exp(-s r) + exp(-s r / 3)) / (8 pi r)      [1/length^2]
//
// A  surface albedo [1]: R integrates to A over the plane, for every s
// s  shape [1/length]: 1 / s is the scattering distance
//
// Source      Christensen and Burley 2015, 'Approximate Reflectance Profiles for Efficient Subsurface Scattering':
//             R eq. 2 and 3, CDF eq. 11, s of the albedo eq. 5, 6 and 8. The slides of 'Efficient Screen-Space
//             Subsurface Scattering' (SIGGRAPH 2018 Advances) print s / (8 pi) (...) as 'the PDF': that is the density
//             over r and azimuth together.
// Departures  everything is written in x = s r and in m = 1 - exp(-x / 3), where nothing cancels.
namespace likeness::brdf {

// Closer than this many scattering distances R is held, where it would grow as 1 / r. Inside lies 5e-13 of the light.
inline constexpr double kBurleyLeastX = 1e-12;

// exp(-x) + exp(-x / 3), of x = s r >= 0.
template <Scalar S>
S burley_sum(const S& x) {
  const S e = exp(S(x * constant<S>(-1.0 / 3.0)));
  return e * (S(1) + e * e);
}

// What a ring of radius r receives, [1/length]: 2 pi r R / A = s / 4 (exp(-s r) + exp(-s r / 3)). Integrates to 1 over r.
template <Scalar S>
S burley_density_over_radius(const S& r, const S& s) {
  return s * S(0.25) * burley_sum(S(s * r));
}

// R / A for s = 1, at x >= 0.
template <Scalar S>
S burley_density_over_area(const S& x) {
  return burley_sum(x) / (larger(x, constant<S>(kBurleyLeastX)) * constant<S>(8 * std::numbers::pi));
}
// R / A, [1/length^2]: the density of points on the plane. Integrates to 1 over the plane.
template <Scalar S>
S burley_density_over_area(const S& r, const S& s) {
  return s * s * burley_density_over_area(S(s * r));
}

// R(r), [1/length^2].
template <Scalar S>
S burley_profile(const S& r, const S& s, const S& albedo) {
  return albedo * burley_density_over_area(r, s);
}

// The part of the light that leaves within x scattering distances: 1 - exp(-x) / 4 - 3 exp(-x / 3) / 4, with all its
// digits near x = 0, where it is x / 2.
template <Scalar S>
S burley_cdf(const S& x) {
  const S m = -expm1(S(x * constant<S>(-1.0 / 3.0)));
  return m * (S(6) - m * (S(3) - m)) * S(0.25);
}
// The rest, with all its digits far out: exp(-x) / 4 + 3 exp(-x / 3) / 4. It is also what a slab of thickness x lets
// through (brdf/subsurface/slab_transmission.h).
template <Scalar S>
S burley_beyond(const S& x) {
  const S e = exp(S(x * constant<S>(-1.0 / 3.0)));
  return e * (S(3) + e * e) * S(0.25);
}

// The distance, in scattering distances, within which the part u of the light leaves: the inverse of burley_cdf.
// `rest` is 1 - u, given apart so that neither end loses digits; a rest below 1e-30 counts as 1e-30 (x = 206).
//
//     y = exp(-x / 3) solves y^3 + 3 y = 4 (1 - u):  y = c - 1/c,  c^3 = 2 (1 - u) + sqrt(1 + 4 (1 - u)^2)
//
// Source      Cardano; in this use Golubev, 'Sampling Burley's Normalized Diffusion Profiles', eq. 5 and 6 (there in
//             1 / c, and x as the logarithm of a sum that loses x near 0: 79 % of it in float below u = 1e-5).
// Departures  y and m = 1 - y are each taken as a product of positive terms: y from c^3 - 1/c^3 = 4 (1 - u), and m from
//             the difference to the golden ratio phi, which is c at u = 0. Then x = 3 ln(1 / y) = 3 log1p(m / y).
//             There is no step of Newton's left to do: 1e-15 in double and 4e-7 in float for every u.
template <Scalar S>
S burley_icdf(const S& u, const S& rest) {
  constexpr double kRoot5 = 2.2360679774997897, kPhi = std::numbers::phi;
  const S w = larger(rest, constant<S>(1e-30));
  const S q = sqrt(S(S(1) + S(4) * w * w));
  const S c = cbrt(S(S(2) * w + q));
  const S phi = constant<S>(kPhi), root5 = constant<S>(kRoot5);
  // c^3 is 2 + sqrt 5 = phi^3 at u = 0; this much more than here, divided by u:
  const S cubes = S(2) + S(4) * (S(1) + w) / (root5 + q);
  const S m = u * cubes / (phi * phi + c * (phi + c)) * (S(1) + S(1) / (c * phi));
  const S y = S(4) * w / (S(1) + c * c + S(1) / (c * c));
  return S(3) * log1p(S(m / y));
}

// The same by `steps` steps of Halley's method from x = 10^u - 1, as the talk has it (the start is that of the engine it
// describes). From below it converges, but by at most 6 in x a step: good for the few samples of a filter, wrong for u
// near 1 (docs/models/burley_profile.md has the errors). u and rest as above.
template <Scalar S>
S burley_halley_start(const S& u) {
  return expm1(S(u * constant<S>(std::numbers::ln10)));
}
template <Scalar S>
S burley_halley_step(const S& x, const S& u, const S& rest) {
  const S e = exp(S(x * constant<S>(-1.0 / 3.0))), e3 = e * e * e;
  // CDF - u, from the end of the range where it cancels less.
  const S excess = pick(greater(S(0.5), u), S(burley_cdf(x) - u), S(rest - burley_beyond(x)));
  const S slope = (e3 + e) * S(0.25), bend = -(e3 + e * constant<S>(1.0 / 3.0)) * S(0.25);
  return x - excess / (slope - excess * bend / (S(2) * slope));
}
template <int kSteps, Scalar S>
S burley_icdf_halley(const S& u, const S& rest) {
  S x = burley_halley_start(u);
  for (int i = 0; i < kSteps; ++i) x = burley_halley_step(x, u, rest);
  return x;
}

// The shape for a surface albedo A in [0, 1], as fitted by Christensen and Burley to random walks. Divide by the length
// that is named to get s. `docs/models/random_walk_profile.md` has these against our own walks: they hold for isotropic
// scattering and a boundary that neither reflects nor refracts.
//
// Light enters along the normal ('searchlight'); length: mean free path. Eq. 5: 1.85 - A + 7 |A - 0.8|^3
template <Scalar S>
S burley_shape_searchlight(const S& albedo) {
  const S d = albedo - constant<S>(0.8);
  return constant<S>(1.85) - albedo + S(7) * d * d * larger(d, S(-d));
}
// Light enters from all sides ('diffuse surface transmission'); length: mean free path. Eq. 6: 1.9 - A + 3.5 (A - 0.8)^2
template <Scalar S>
S burley_shape_diffuse(const S& albedo) {
  const S d = albedo - constant<S>(0.8);
  return constant<S>(1.9) - albedo + constant<S>(3.5) * d * d;
}
// Searchlight; length: diffuse mean free path on the surface. Eq. 8: 3.5 + 100 (A - 0.33)^4
template <Scalar S>
S burley_shape_dmfp(const S& albedo) {
  const S d2 = squared(S(albedo - constant<S>(0.33)));
  return constant<S>(3.5) + S(100) * d2 * d2;
}

}  // namespace likeness::brdf
