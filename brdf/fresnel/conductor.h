#pragma once

#include "brdf/fresnel/exact_sum.h"

namespace likeness::brdf {

// What the reflectance of a smooth boundary to an absorbing medium depends on, without cancellation (see
// DielectricBoundary). The medium's index over that of the transparent one in front of it is m = eta + i k.
template <Scalar S>
struct ConductorBoundary {
  S cos_i;  // in [0, 1]
  S eta, k;
  S contrast2;       // |m^2 - 1|^2
  S refracted_cos2;  // real part of m^2 - sin_i^2; the imaginary part is 2 eta k

  ConductorBoundary() = default;

  // cos_i  is clamped to [0, 1]: there is no ray from inside.
  // eta, k  not negative.
  ConductorBoundary(const S& cosine, const S& eta_, const S& k_) : cos_i(clamp01(cosine)), eta(eta_), k(k_) {
    const S k2 = k * k;
    contrast2 = (squared(S(eta - S(1))) + k2) * (squared(S(eta + S(1))) + k2);
    refracted_cos2 =
        ExactSum<S>().add_product(eta, eta).add(S(-1)).add_product(S(-k), k).add_product(cos_i, cos_i).value();
  }
};

// Fresnel reflectance of unpolarised light at the surface of a metal, exact, [1]: the mean of |r_s|^2 and |r_p|^2,
//
//     r_s = -(m^2 - 1) / (cos_i + g)^2,     g = sqrt(m^2 - sin_i^2), both parts of it not negative
//     r_p = (m^2 - 1) q / (m^2 cos_i + g)^2
//     q = (m^2 + 1) cos_i^2 - 1 = (m^2 + 1) g^2 - m^4
//
// Source      Born and Wolf, Principles of Optics, section 14.2, with the products that do not cancel.
// Holds       F in [0, 1]; 1 at grazing; fresnel_dielectric at k = 0, total reflection included.
template <Scalar S>
S fresnel_conductor(const ConductorBoundary<S>& b) {
  const S c = b.cos_i, y = S(2) * b.eta * b.k, x = b.refracted_cos2;  // g^2 = x + i y
  const S g2 = root_or_zero(S(x * x + y * y));                        // |g|^2
  const auto mostly_real = greater(x, S(0));
  const S large = root_or_zero(S(S(0.5) * (g2 + pick(mostly_real, x, S(-x)))));
  const auto usable = greater(large, S(0));
  const S small = pick(usable, S(S(0.5) * y / pick(usable, large, S(1))), S(0));
  const S g_re = pick(mostly_real, large, small), g_im = pick(mostly_real, small, large);

  const S eta2 = b.eta * b.eta, k2 = b.k * b.k, m_re = eta2 - k2;  // m^2 = m_re + i y
  const S s = g2 + c * (c + S(2) * g_re);                          // |cos_i + g|^2
  const S p = g2 + c * (squared(S(eta2 + k2)) * c + S(2) * (m_re * g_re + y * g_im));
  const S c2 = c * c, m4 = squared(S(eta2 + k2));  // |m^2|^2
  const auto dense = greater(m4, S(1));            // which of the two forms of q does not cancel
  const S q_re = pick(dense, S((m_re + S(1)) * c2 - S(1)), S((m_re + S(1)) * x - y * y - (m_re * m_re - y * y)));
  const S q_im = pick(dense, S(y * c2), S((m_re + S(1)) * y + y * x - S(2) * m_re * y));
  const auto s_exists = greater(s, S(0)), p_exists = greater(p, S(0));
  const S s_or_1 = pick(s_exists, s, S(1)), p_or_1 = pick(p_exists, p, S(1));
  const S sum = b.contrast2 / s_or_1 / s_or_1 + b.contrast2 / p_or_1 * (q_re * q_re + q_im * q_im) / p_or_1;
  // s is 0 at cos_i = 0, m = 1, where there is no boundary; p alone at cos_i = 1, m = 0.
  return pick(s_exists, pick(p_exists, smaller(S(S(0.5) * sum), S(1)), S(1)), S(0));
}
template <Scalar S>
S fresnel_conductor(const S& cos_i, const S& eta, const S& k) {
  return fresnel_conductor(ConductorBoundary<S>(cos_i, eta, k));
}

}  // namespace likeness::brdf
