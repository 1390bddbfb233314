#pragma once

#include <array>
#include <numbers>

#include "brdf/fresnel/dielectric.h"
#include "brdf/hair/scaled_exp.h"

// How a fibre scatters around itself, for light that hits it at an offset h from its axis (in radii, -1 to 1).
// Lobes: p = 0 is R, 1 is TT, 2 is TRT, 3 stands for all longer paths together.
namespace likeness::brdf {

inline constexpr int kHairLobes = 4;

// Four times the peak of the trimmed logistic: 1 / (s tanh(pi / (2 s))).
template <Scalar S>
S trimmed_logistic_scale(const S& s) {
  return S(1) / S(s * tanh(S(constant<S>(std::numbers::pi / 2) / s)));
}
template <Scalar S>
S trimmed_logistic(const S& distance, const S& s, const S& scale) {
  const S half = exp(S(S(-0.5) * distance / s)), ratio = half / S(S(1) + half * half);
  return scale * ratio * ratio;
}
// Logistic distribution of width s > 0 cut to [-pi, pi], [1/rad]; its integral there is 1. Reads |x| and s; x is 0 at
// the peak. Source  Chiang 2016 (D_p); the integral of the logistic over [-pi, pi] is tanh(pi / (2 s)).
template <Scalar S>
S trimmed_logistic(const S& distance, const S& s) {
  return trimmed_logistic(distance, s, trimmed_logistic_scale(s));
}
// x drawn with that density from u in [0, 1).
template <Scalar S>
S sample_trimmed_logistic(const S& s, const S& u) {
  const S a = (S(2) * u - S(1)) * tanh(S(constant<S>(std::numbers::pi / 2) / s));
  const S most = constant<S>(1 - (sizeof(typename Arithmetic<S>::Number) == 4 ? 0x1p-24 : 0x1p-53));
  const S b = smaller(larger(a, S(-most)), most);  // at u = 0 a tail of infinite length
  const S x = s * (log1p(b) - log1p(S(-b)));
  return smaller(larger(x, constant<S>(-std::numbers::pi)), constant<S>(std::numbers::pi));
}

// What a fibre of index eta >= 1 does to light at offset h, in the plane across it.
//
//     sin gamma_i = h            sin gamma_t = h / eta',   eta' = sqrt(eta^2 - sin^2 theta) / cos theta
//     sin theta_t = sin theta / eta
//     reflected   dielectric Fresnel, unpolarised, exact, at the cosine cos theta sqrt(1 - h^2)
//
// Source  Marschner 2003 (section 4: gamma, eta'); d'Eon 2011 (one Fresnel term at the cosine of the true angle).
// Everything is written in eta^2 - 1 and cos theta: no difference of near numbers near eta = 1, h = +-1 or
// theta = 90 degrees, and reflected + transmitted = 1 to rounding with neither taken from the other.
template <Scalar S>
struct FibrePath {
  S gamma_i, gamma_t;        // [rad]
  S chord;                   // cos gamma_t / cos theta_t: half of the way between two hits, in radii
  S reflected, transmitted;  // at one hit

  // h = sin gamma, cos_h = cos gamma.
  FibrePath(const S& gamma, const S& h, const S& cos_h, const S& cos_theta, const S& eta) : gamma_i(gamma) {
    const S q = (eta - S(1)) * (eta + S(1)), cosine = cos_theta * cos_h;
    const S outer2 = q + cos_theta * cos_theta;  // (eta cos theta_t)^2
    const S inner2 = q + cosine * cosine;        // (eta cos of the refracted angle)^2
    const auto usable = greater(outer2, constant<S>(kTiny<S>));
    const S outer2_or_1 = pick(usable, outer2, S(1)), outer = sqrt(outer2_or_1);
    const S sin_t = h * pick(usable, S(cos_theta / outer), S(1));
    const S cos_t = safe_sqrt(pick(usable, S(inner2 / outer2_or_1), S(cos_h * cos_h)));
    gamma_t = atan2(sin_t, cos_t);
    chord = eta * cos_t / pick(usable, outer, constant<S>(kTiny<S>));

    DielectricBoundary<S> boundary;
    boundary.cos_i = cosine;
    boundary.index2 = eta * eta;
    boundary.contrast = q;
    boundary.refracted_cos2 = inner2;
    reflected = fresnel_dielectric(boundary);
    // 1 - reflected, as the mean of both polarisations' own: 4 c g / (c + g)^2 and 4 n^2 c g / (n^2 c + g)^2.
    const S inner = safe_sqrt(inner2), across = cosine + inner, along = boundary.index2 * cosine + inner;
    const auto meets = greater(S(across * across), constant<S>(kTiny<S>));
    const S across2 = pick(meets, S(across * across), S(1)), along2 = pick(meets, S(along * along), S(1));
    transmitted = pick(meets, S(S(2) * cosine * inner * (S(1) / across2 + boundary.index2 / along2)), S(1));
  }
};
template <Scalar S>
FibrePath<S> fibre_path(const S& h, const S& cos_theta, const S& eta) {
  const S cos_h = safe_sqrt(S((S(1) - h) * (S(1) + h)));
  return FibrePath<S>(S(atan2(h, cos_h)), h, cos_h, cos_theta, eta);
}

// The share of the light that leaves by each lobe, [1], after an optical depth `depth` >= 0 between two hits:
// 2 sigma_a cos gamma_t / cos theta_t, sigma_a per radius. With T = exp(-depth), f reflected, g transmitted:
//
//     A_0 = f,  A_p = g^2 f^(p-1) T^p,  and all longer paths:  sum from 3 = g^2 f^2 T^3 / (1 - f T)
//
// Source     Chiang 2016 and d'Eon 2011 (A_p). The slides print exp(-2 mu (1 + cos 2 gamma_t)); the chord of a unit
//            circle is 2 cos gamma_t.
// Departure  g^2 / (1 - f T) is written g^2 / (g + f (1 - T)), which is at most g: no 0 / 0 where f T = 1.
// Holds      without absorption the four add up to 1.
template <Scalar S>
std::array<S, kHairLobes> hair_attenuations(const S& reflected, const S& transmitted, const S& depth) {
  const S g2 = transmitted * transmitted, t = exp(S(-depth)), lost = S(-expm1(S(-depth)));
  const S tt = g2 * t, trt = tt * reflected * t;
  const S rest = larger(S(transmitted + reflected * lost), constant<S>(kTiny<S>));
  return {reflected, tt, trt, S(trt * reflected * t / rest)};
}

// Distance, in [0, pi], of the azimuth phi from the centre Phi(p, h) = 2 p gamma_t - 2 gamma_i + p pi of lobe p.
// By floor and not by a loop, with pi in two parts, so that what is left of a whole turn has the digits of phi.
template <Scalar S>
S azimuth_distance(const S& p, const S& phi, const S& gamma_i, const S& gamma_t) {
  constexpr bool kFloat = sizeof(typename Arithmetic<S>::Number) == 4;
  constexpr double kHigh = kFloat ? 0x1.92p+1 : std::numbers::pi,
                   kLow = kFloat ? 0x1.fb54442d18469p-11 : 0x1.1a62633145c07p-53;
  const S y = phi - S(2) * (p * gamma_t - gamma_i);
  const S turns = floor(S((y * constant<S>(1 / std::numbers::pi) - p + S(1)) * S(0.5)));
  const S half_turns = p + S(2) * turns;
  const S x = (y - half_turns * constant<S>(kHigh)) - half_turns * constant<S>(kLow);
  return S(abs(x));
}

// Azimuthal scattering at one offset, near field: N_p = A_p(h) D(phi - Phi(p, h)), [1/rad]; the longer paths (p = 3)
// leave evenly: A_3 / (2 pi). p is a whole number from 0 to 3.
template <Scalar S>
S hair_near(const S& p, const S& distance, const S& s, const S& depth, const S& reflected, const S& transmitted) {
  const auto a = hair_attenuations(reflected, transmitted, depth);
  const auto above_0 = greater(p, S(0.5)), above_1 = greater(p, S(1.5)), above_2 = greater(p, S(2.5));
  const S attenuation = pick(above_2, a[3], pick(above_1, a[2], pick(above_0, a[1], a[0])));
  return attenuation * pick(above_2, constant<S>(0.5 / std::numbers::pi), trimmed_logistic(distance, s));
}

}  // namespace likeness::brdf
