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
    .weight = {0.72581415997}, .variance = {5.6452180259}, .delta = 1 - 0.72581415997};
template <>
inline constexpr GaussianFit<2> kGaussianFit<2>{.weight = {0.53620840843, 1 - 0.53620840843},
                                                .variance = {0.44110685334, 11.354974669}};
template <>
inline constexpr GaussianFit<4> kGaussianFit<4>{
    .weight = {0.15366786955, 0.30095779111, 0.35737752982, 1 - (0.15366786955 + 0.30095779111 + 0.35737752982)},
    .variance = {0.029949839305, 0.59464247544, 4.6071812052, 25.941070219}};

// R / A without the delta, for s = 1, of x2 = (s r)^2 >= 0.
template <int kCount, Scalar S>
S gaussian_density_over_area(const S& x2) {
  constexpr const auto& kFit = kGaussianFit<kCount>;
  S sum(0.0);
  for (int i = 0; i < kCount; ++i)
    sum = sum + constant<S>(kFit.weight[i] / (2 * std::numbers::pi * kFit.variance[i])) *
                    exp(S(x2 * constant<S>(-0.5 / kFit.variance[i])));
  return sum;
}
// The part of the light that leaves within x, the delta included: D at x = 0.
template <int kCount, Scalar S>
S gaussian_cdf(const S& x2) {
  constexpr const auto& kFit = kGaussianFit<kCount>;
  S sum = constant<S>(kFit.delta);
  for (int i = 0; i < kCount; ++i)
    sum = sum - constant<S>(kFit.weight[i]) * expm1(S(x2 * constant<S>(-0.5 / kFit.variance[i])));
  return sum;
}

// R(r) without the delta, [1/length^2].
template <int kCount, Scalar S>
S gaussian_profile(const S& r, const S& s, const S& albedo) {
  return albedo * s * s * gaussian_density_over_area<kCount>(squared(S(s * r)));
}

}  // namespace likeness::brdf
