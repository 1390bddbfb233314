#pragma once

#include "brdf/fresnel/exact_sum.h"

namespace likeness::brdf {

// What the reflectance of a smooth boundary between two transparent media depends on, without cancellation. Rounded to
// a lower precision it loses nothing: 1 - n^2 and the cosine of the refracted ray are numbers of their own.
template <Scalar S>
struct DielectricBoundary {
  S cos_i;           // of the incident ray, in [0, 1]
  S index2;          // n^2
  S contrast;        // n^2 - 1
  S refracted_cos2;  // n^2 - sin_i^2 = (n cos_t)^2; not above 0: total internal reflection

  DielectricBoundary() = default;

  // cos_i  in [-1, 1]. Below 0 the ray arrives from the other side: as |cos_i| with 1 / eta.
  // eta    index of the medium behind the boundary over that in front of it, above 0.
  DielectricBoundary(const S& cosine, const S& eta) {
    const auto behind = greater(S(0), cosine);
    const S n = pick(behind, S(S(1) / eta), eta);
    cos_i = smaller(pick(behind, S(-cosine), cosine), S(1));
    ExactSum<S> sum;
    index2 = n * n;
    contrast = sum.add_product(n, n).add(S(-1)).value();
    refracted_cos2 = sum.add_product(cos_i, cos_i).value();
  }
};

// Fresnel reflectance of unpolarised light at a boundary between transparent media, [1]: the mean of r_s^2 and r_p^2,
//
//     r_s = (cos_i - g) / (cos_i + g) = -(n^2 - 1) / (cos_i + g)^2,     g = sqrt(n^2 - sin_i^2)
//     r_p = (n^2 cos_i - g) / (n^2 cos_i + g) = (n^2 - 1) q / (n^2 cos_i + g)^2
//     q = (n^2 + 1) cos_i^2 - 1 = (n^2 + 1) g^2 - n^4, 0 at Brewster's angle
//
// and 1 where g is not real (total internal reflection). The forms to the right do not cancel at n near 1, nor the
// second of q at n near 0.
// Source      Born and Wolf, Principles of Optics, section 1.5.2.
// Holds       F in [0, 1]; 1 at grazing, to the last bit; 0 where n = 1, at cos_i = 0 too, where the limit of n to 1 is 1
//             and that of cos_i to 0 is 0; continuous into total reflection (with infinite slope).
// Does not    see polarisation: what is reflected twice needs both.
template <Scalar S>
S fresnel_dielectric(const DielectricBoundary<S>& b) {
  const auto refracts = greater(b.refracted_cos2, S(0));
  const S g2 = pick(refracts, b.refracted_cos2, S(1)), g = sqrt(g2), p = b.index2 * b.cos_i;
  const S r_s = b.contrast / (g2 + b.cos_i * (b.cos_i + S(2) * g));
  const S q = pick(greater(b.contrast, S(0)), S((b.index2 + S(1)) * b.cos_i * b.cos_i - S(1)),
                   S((b.index2 + S(1)) * g2 - b.index2 * b.index2));
  const S r_p = b.contrast * q / (g2 + p * (p + S(2) * g));
  const auto differs = either(greater(b.contrast, S(0)), greater(S(0), b.contrast));
  return pick(refracts, smaller(S(S(0.5) * (r_s * r_s + r_p * r_p)), S(1)), pick(differs, S(1), S(0)));
}
template <Scalar S>
S fresnel_dielectric(const S& cos_i, const S& eta) {
  return fresnel_dielectric(DielectricBoundary<S>(cos_i, eta));
}

}  // namespace likeness::brdf
