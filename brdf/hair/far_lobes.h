#pragma once

#include <array>
#include <cmath>

#include "brdf/vector.h"

// What the run-time forms of a fibre's far field share: the lobes that they return, and what absorption does to a lobe
// of whose ways only a few numbers are known.
namespace likeness::brdf {

// Azimuthal scattering N_p of R, TT, TRT and of all longer paths together, [1/rad].
template <Scalar S>
struct HairFarLobes {
  S r = S(0.0);
  Rgb<S> tt, trt, longer;
};

// The logarithm of a factor for each lobe: what is to be multiplied by an exponential anyway, as M_p begins with one,
// costs none of its own.
template <Scalar S>
using HairLogFactors = std::array<S, 4>;
template <Scalar S>
HairLogFactors<S> no_factors() {
  return {S(0.0), S(0.0), S(0.0), S(0.0)};
}

// f(channel of a) for each channel.
template <Scalar S, class F>
Rgb<S> for_channels(const Rgb<S>& a, F&& f) {
  return {S(f(a.r)), S(f(a.g)), S(f(a.b))};
}

// The shortest way through a fibre, [radii], the chord of a ray that grazes it (h = +-1):
// 2 eta sqrt(eta^2 - 1) / (eta^2 - 1 + cos^2 theta).
template <Scalar S>
S hair_least_way(double eta, const S& cos_theta) {
  const double q = (eta - 1) * (eta + 1);
  return constant<S>(2 * eta * std::sqrt(q)) / (constant<S>(q) + cos_theta * cos_theta);
}

// The light of a lobe that leaves at one azimuth came along ways of many lengths: `least` at least, `least + more` in
// the mean. What is left of it after absorption is about e^-depth,
//
//     depth = sigma (least + more / (1 + curve sigma))
//
// exact for a single length, at sigma = 0 in value and slope, and in the slope as sigma grows. With a curve fitted near
// sigma = 2, N_TT and N_TRT keep their value within 0.3 % and 2 % up to sigma = 4 (1600 random azimuths and widths).
template <Scalar S>
S hair_depth(const S& sigma, const S& least, const S& more, const S& curve) {
  return sigma * (least + more / (S(1) + curve * sigma));
}

// What is left of all paths of three passes and more, as if each pass had the depth `depth` and each hit let the share
// u in (0, 1] out: t^3 u / (u + (1 - u) (1 - t)), t = e^-depth.
template <Scalar S>
S hair_longer_share(const S& depth, const S& u) {
  const S t = exp(S(-depth)), lost = S(-expm1(S(-depth)));
  return t * t * t * u / S(u + (S(1) - u) * lost);
}

}  // namespace likeness::brdf
