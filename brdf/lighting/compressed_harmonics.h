#pragma once

#include "brdf/lighting/spherical_harmonics.h"

namespace likeness::brdf {

// Radiance as spherical harmonics for storage: band 0 as it is (16 bits or a float), bands 1 and 2 as numbers in [0, 1]
// relative to it, which 8 bits hold.
//
//     e_i = 1/2 + c_i / (2 bound_i c_0),   i = 1 to 8;   e_i = 1/2 where c_0 is not above 1e-36
//
// The bounds hold for every radiance that is nowhere negative, because |c_i| / c_0 is a mean of |Y_i| / Y_0, and its
// largest is that of one light: sqrt 3 for band 1; sqrt 15 / 2 for xy, yz, xz, x^2 - y^2; sqrt 5 for 3 z^2 - 1. What
// exceeds them, as ringing and subtracted light can, is clamped.
//
// Source      The talk 'Probe lighting, strand hair and hair shading in Enemies', after O'Donnell 2018 ("Precomputed
//             Global Illumination in Frostbite"): '[0..1] values in function of L0 in 8 bit per channel'.
// Departures  their ranges are not in the talk; these are derived.
template <Scalar S>
struct CompressedSh {
  S l0 = S(0.0);                // c_0, not negative
  std::array<S, 8> e = grey();  // [0, 1]

  CompressedSh() = default;
  explicit CompressedSh(const Sh<S>& from) : l0(positive(from.c[0])) {
    const auto usable = greater(l0, constant<S>(1e-36));  // 1 / (2 l0) is a float
    const S per_l0 = S(0.5) / pick(usable, l0, S(1));
    for (std::size_t i = 0; i < 8; ++i)
      e[i] = pick(usable, clamp01(S(S(0.5) + from.c[i + 1] * per_l0 * constant<S>(1 / bound(i)))), S(0.5));
  }

  Sh<S> expanded() const {
    Sh<S> out;
    out.c[0] = l0;
    for (std::size_t i = 0; i < 8; ++i) out.c[i + 1] = (S(2) * e[i] - S(1)) * (l0 * constant<S>(bound(i)));
    return out;
  }

  // e rounded to one of 255 levels, of which the middle one, 127, is a coefficient of 0: ambient light stays ambient.
  // A texture that holds the level as 8 bits of [0, 1] gives level / 255: multiply it by 255 / 254.
  // Error   a coefficient by at most bound c_0 / 254, 0.7 to 0.9 % of c_0.
  CompressedSh rounded_to_levels() const {
    CompressedSh out;
    out.l0 = l0;
    for (std::size_t i = 0; i < 8; ++i) out.e[i] = floor(S(e[i] * S(254) + S(0.5))) * constant<S>(1.0 / 254);
    return out;
  }

  static constexpr double bound(std::size_t i) {
    return i < 3 ? 1.7320508075688772 : i == 5 ? 2.2360679774997898 : 1.9364916731037085;
  }

 private:
  static std::array<S, 8> grey() { return {S(0.5), S(0.5), S(0.5), S(0.5), S(0.5), S(0.5), S(0.5), S(0.5)}; }
};

}  // namespace likeness::brdf
