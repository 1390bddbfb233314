#pragma once

#include <numbers>

#include "brdf/hair/bessel.h"
#include "brdf/hair/scaled_exp.h"

// How a fibre scatters along itself. Inclinations theta are angles from the normal plane of the fibre, in
// [-pi/2, pi/2]; a smooth fibre sends light from theta_o to theta_i = -theta_o.
namespace likeness::brdf {

// Sine and cosine of an inclination; the cosine is not negative.
template <Scalar S>
struct Inclination {
  S sine, cosine;
};

// 1 - cos(theta_i + theta_o) from sines and cosines, without cancellation: half the squared distance between one and the
// mirror image of the other.
template <Scalar S>
S versine_of_sum(const Inclination<S>& i, const Inclination<S>& o) {
  return S(0.5) * (squared(S(i.cosine - o.cosine)) + squared(S(i.sine + o.sine)));
}

// 1 / (v (1 - exp(-2 / v))), which M_p has as a factor.
template <Scalar S>
S hair_mp_scale(const S& v) {
  return S(-1) / S(v * expm1(S(S(-2) / v)));
}

// Energy-conserving longitudinal term, [1/rad / cos]: the integral of M cos(theta_i) over theta_i is 1 for every theta_o
// and v. Symmetric in theta_i and theta_o. v > 0 is a variance, [rad^2] where it is small.
//
//     M = csch(1/v) / (2 v) exp(-sin(theta_i) sin(theta_o) / v) I0(cos(theta_i) cos(theta_o) / v)
//
// Source     d'Eon 2011 ("An Energy-Conserving Hair Reflectance Model"), section 4.1, as printed in the Enemies slides.
// Departure  none in value. With the exponents of csch, exp and I0 taken out and combined,
//
//     M = exp(-(1 - cos(theta_i + theta_o)) / v)  exp(-x) I0(x)  / (v (1 - exp(-2 / v))),   x = cos cos / v
//
//            nothing overflows from v = 1e-6 to 100, and one form serves all of it.
// Reads versine_over_v = (1 - cos(theta_i + theta_o)) / v and cosines_over_v = cos(theta_i) cos(theta_o) / v.
template <Scalar S>
S hair_mp(const S& v, const S& versine_over_v, const S& cosines_over_v) {
  return scaled_exp(S(bessel_i0_scaled(cosines_over_v) * hair_mp_scale(v)), versine_over_v);
}
template <Scalar S>
S hair_mp(const S& v, const Inclination<S>& i, const Inclination<S>& o) {
  return hair_mp(v, S(versine_of_sum(i, o) / v), S(i.cosine * o.cosine / v));
}

// Marschner's longitudinal term: a Gaussian of standard deviation beta > 0 [rad], [1/rad]. theta is theta_i + theta_o
// less the shift of the lobe. Its integral over the line is 1; what of it lies beyond the poles, and the cosine, are why
// it does not conserve energy. Source  Marschner 2003; files 000 and 002, with the minus sign that 002 lost.
// Reads theta / beta and beta.
template <Scalar S>
S hair_gauss(const S& beta, const S& theta_over_beta) {
  constexpr double kRoot = 0.39894228040143268;  // 1 / sqrt(2 pi)
  return scaled_exp(S(constant<S>(kRoot) / beta), S(S(0.5) * theta_over_beta * theta_over_beta));
}

// An inclination drawn with density M(theta_i, o) cos(theta_i) from u, w in [0, 1): the direction on the sphere is
// von Mises-Fisher about the mirror direction, and cos and sin of its distance are written from the versine, so that
// neither a small v nor a pole cancels anything. Source  d'Eon 2013 ("Importance Sampling for Physically-Based Hair
// Fiber Models"); Departure  log1p and expm1 forms, and a cosine from its components instead of from the sine.
template <Scalar S>
Inclination<S> sample_hair_mp(const S& v, const Inclination<S>& o, const S& u, const S& w) {
  const S versine = smaller(S(-v * log1p(S(u * expm1(S(S(-2) / v))))), S(2));
  const S sine = safe_sqrt(S(versine * (S(2) - versine))), cosine = S(1) - versine;
  const S turn = w * constant<S>(2 * std::numbers::pi);
  const S in_plane = sine * cos(turn), across = sine * sin(turn);
  const S along = in_plane * o.cosine - cosine * o.sine, outwards = cosine * o.cosine + in_plane * o.sine;
  return {along, safe_sqrt(S(outwards * outwards + across * across))};
}

}  // namespace likeness::brdf
