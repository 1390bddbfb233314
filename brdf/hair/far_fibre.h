#pragma once

#include "brdf/hair/far.h"
#include "brdf/hair/fibre.h"

namespace likeness::brdf {

// What a pair of directions comes to for a fibre seen from afar, when it covers less than a pixel: the offset is
// averaged out.
template <Scalar S>
struct HairFarTerms {
  HairTerms<S> longitudinal;  // of any offset: v, versine, cosines, s and cos_i are read
  S phi, eta, cos_o;
  Rgb<S> sigma_a;

  // S cos(theta_i) averaged over the width of the fibre, [1/sr]: sum over p of M_p N_p, each N_p by hair_far() to
  // `tolerance`. For plain numbers and Jets of doubles; ten quadratures, 0.1 to 0.3 ms.
  // Holds  without absorption the integral over the light is 1.
  Rgb<S> eval_cos(double tolerance = 1e-9) const {
    const HairTerms<S>& t = longitudinal;
    const auto n = [&](int p, const S& absorption) {
      return hair_far<S>(p, phi, t.s, absorption, eta, cos_o, tolerance);
    };
    Rgb<S> sum(S(hair_mp(t.v[0], t.versine[0], t.cosines[0]) * n(0, S(0.0))));
    for (int p = 1; p < kHairLobes; ++p) {
      const std::size_t at = std::size_t(p);
      const S m = hair_mp(t.v[std::min(at, std::size_t(2))], t.versine[at], t.cosines[at]);
      sum = sum + Rgb<S>{n(p, sigma_a.r), n(p, sigma_a.g), n(p, sigma_a.b)} * m;
    }
    return sum;
  }
};
template <Scalar S>
HairFarTerms<S> hair_far_terms(const HairFibre<S>& fibre, const Inclination<S>& i, const Inclination<S>& o,
                               const S& phi) {
  return {fibre.view(o, S(0.0), S(0.0)).terms(i, phi), phi, fibre.eta, o.cosine, fibre.sigma_a};
}

}  // namespace likeness::brdf
