#pragma once

#include "brdf/hair/azimuthal.h"
#include "brdf/hair/lut.h"

namespace likeness::brdf {

// The table of the Enemies talk: the distribution alone, 1/2 integral of D_p(phi - Phi(p, h)) dh, [1/rad], for R, TT and
// TRT, linear between evenly spaced phi, cos(theta_d) and beta_n. The slide drops the 1/2; it is in here, so that each
// lobe integrates to 1. The talk states neither the size of the table nor its range of beta_n: ours has 64 x 32 x 32
// nodes over beta_n from 0.1 to 1, which is kinder to it than a range from 0.
struct HairTalkLut {
  static constexpr double kLeastBeta = 0.1;
  double eta = 1.55;
  HairGrid distribution{.phi = 64, .cosine = 32, .width = 32, .values = 3};

  std::size_t bytes() const { return sizeof(float) * distribution.count(); }

  // distance = |phi| in [0, pi]; out has three entries.
  template <Scalar S>
  void read(const S& distance, const S& cos_d, const S& beta_n, S* out) const {
    distribution.read(S(distance * constant<S>(1 / std::numbers::pi)), cos_d,
                      S((beta_n - constant<S>(kLeastBeta)) * constant<S>(1 / (1 - kLeastBeta))), out);
  }
};

// The talk's attenuations at one dominant offset for each path: A_R by Fresnel at half_cosine = sqrt(1/2 + 1/2 wi.wo),
// A_TT = A(1, 0), A_TRT = A(2, sqrt(3) / 2). Source  slide 'A_R, A_TT, A_TRT' of the Enemies talk. Departure  absorption
// over the chord 2 cos(gamma_t) / cos(theta_t), as in the reference (errata.md), not 2 (1 + cos 2 gamma_t).
template <Scalar S>
HairFarLobes<S> hair_talk_attenuations(const S& half_cosine, const S& cos_d, const S& eta, const Rgb<S>& sigma_a) {
  const auto path = [&](double h, double cos_h, const S& cosine) {
    return FibrePath<S>(constant<S>(std::asin(h)), constant<S>(h), constant<S>(cos_h), cosine, eta);
  };
  const FibrePath<S> r = path(0, 1, half_cosine), tt = path(0, 1, cos_d), trt = path(0.86602540378443865, 0.5, cos_d);
  const auto attenuated = [&](const FibrePath<S>& at, std::size_t p) {
    return for_channels(sigma_a, [&](const S& sigma) {
      return hair_attenuations(at.reflected, at.transmitted, S(S(2) * sigma * at.chord))[p];
    });
  };
  HairFarLobes<S> a;
  a.r = r.reflected;
  a.tt = attenuated(tt, 1);
  a.trt = attenuated(trt, 2);
  return a;
}

}  // namespace likeness::brdf
