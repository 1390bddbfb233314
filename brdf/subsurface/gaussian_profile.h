#pragma once

#include <array>
#include <numbers>

#include "brdf/scalar.h"

// Sums of Gaussians in the place of Burley's profile: each is separable and turns into a wider one by convolution with
// itself, which made real-time filters of them.
//
//     R(r) = A (delta(r) D + sum_i w_i exp(-(s r)^2 / (2 v_i)) s^2 / (2 pi v_i)),   D + sum_i w_i = 1
//
// A, s  as in brdf/subsurface/burley_profile.h; D is the part that is not blurred at all, a Dirac delta at r = 0
//
// Source  the forms: one Gaussian and a delta (Mikkelsen 2010, 'Skin Rendering by Pseudo-Separable Cross Bilateral
//         Filtering'), two (Jimenez et al. 2014, 'Separable Subsurface Scattering'), four (d'Eon, Luebke and Enderton 2007,
//         'Efficient Rendering of Human Skin'), as the slides of 'Efficient Screen-Space Subsurface Scattering' list them.
// Departures  those papers fit skin. Here all three are fitted to one target, Burley's profile, by the least
//         integral over r of (CDF - Burley's CDF)^2: so a delta counts, and the long tail. `subsurface_study` makes the
//         numbers again; docs/models/gaussian_profile.md has their errors.
// Holds   energy is 1 to the last bit or two, weights are positive.
namespace likeness::brdf {

template <int kCount>
struct GaussianFit {
  std::array<double, kCount> weight, variance;  // variance along one axis, for s = 1; growing
  double delta = 0;                             // D
};

template <int kCount>
inline constexpr GaussianFit<kCount> kGaussianFit;
template <>
inline constexpr GaussianFit<1> kGaussianFit<1>{
    .weight = {0.72581416}, .variance = {5.64521802}, .delta = 1 - 0.72581416};
template <>
inline constexpr GaussianFit<2> kGaussianFit<2>{.weight = {0.53620841, 1 - 0.53620841},
                                                .variance = {0.44110687, 11.35497493}};
template <>
inline constexpr GaussianFit<4> kGaussianFit<4>{
    .weight = {0.15366786, 0.30095779, 0.35737754, 1 - 0.15366786 - 0.30095779 - 0.35737754},
    .variance = {0.02994983, 0.59464241, 4.607181, 25.94106994}};

// R / A without the delta, for s = 1, at x = s r >= 0.
template <int kCount, Scalar S>
S gaussian_density_over_area(const S& x) {
  constexpr const auto& kFit = kGaussianFit<kCount>;
  S sum(0.0);
  for (int i = 0; i < kCount; ++i)
    sum = sum + constant<S>(kFit.weight[i] / (2 * std::numbers::pi * kFit.variance[i])) *
                    exp(S(x * x * constant<S>(-0.5 / kFit.variance[i])));
  return sum;
}
// The part of the light that leaves within x, the delta included: at x = 0 it is D.
template <int kCount, Scalar S>
S gaussian_cdf(const S& x) {
  constexpr const auto& kFit = kGaussianFit<kCount>;
  S sum = constant<S>(kFit.delta);
  for (int i = 0; i < kCount; ++i)
    sum = sum - constant<S>(kFit.weight[i]) * expm1(S(x * x * constant<S>(-0.5 / kFit.variance[i])));
  return sum;
}

// R(r) without the delta, [1/length^2].
template <int kCount, Scalar S>
S gaussian_profile(const S& r, const S& s, const S& albedo) {
  return albedo * s * s * gaussian_density_over_area<kCount>(S(s * r));
}

}  // namespace likeness::brdf
