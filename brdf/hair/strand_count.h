#pragma once

#include <cstddef>
#include <numbers>

#include "brdf/vector.h"

// How many strands lie between a point and the light, as a function of the light's direction: a real spherical harmonic
// of bands 0 and 1, four numbers for each point of a volume. Enemies slides ("project it all down into an L1 band").
namespace likeness::brdf {

// n(w) = mean + dot(gradient, w), which is band 0 and 1 written without their constants: the coefficients of the
// orthonormal harmonics are c00 = sqrt(4 pi) mean and (c1-1, c10, c11) = sqrt(4 pi / 3) (y, z, x of gradient).
//
// Holds  n >= 0 for every direction once kept_positive() was called: the gradient is then at most as long as the mean.
//        Public codes take abs() or max(., 0) at each lookup instead, which changes the mean.
template <Scalar S>
struct StrandCount {
  S mean = S(0.0);
  Vec3<S> gradient;

  // Strands in direction w (unit).
  S eval(const Vec3<S>& w) const { return positive(S(mean + dot(gradient, w))); }

  // Adds a traced direction: `strands` met along w, for `directions` directions that cover the sphere evenly.
  void add(const Vec3<S>& w, const S& strands, double directions) {
    const S share = strands * constant<S>(1 / directions);
    mean = mean + share;
    gradient = gradient + w * S(S(3) * share);
  }

  // The same function with its gradient shortened so far that nothing is negative; the mean stays.
  StrandCount kept_positive() const {
    const S length2 = dot(gradient, gradient), least = positive(mean);
    const auto too_long = greater(length2, S(least * least));
    const S scale = pick(too_long, S(least / sqrt(larger(length2, constant<S>(kTiny<S>)))), S(1));
    return {least, gradient * scale};
  }
};

}  // namespace likeness::brdf
