#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "brdf/scalar.h"

// Coefficients of lobes in eight bits.
namespace likeness::brdf {

// The byte of a coefficient of 0. Bytes 1 to 255 stand for -1 to 1, evenly and symmetrically, so that 0 and both ends are
// exact; byte 0 is never written.
inline constexpr int kRealisZero = 128;

// The coefficient [1/sr] that a byte stands for, (byte - 128) / 127 times the multiplier of its lobe [1/sr]: from minus
// the multiplier to the multiplier, and -128 / 127 of it for the byte 0. Finite for every byte if the multiplier is.
// `byte` is a whole number in [0, 255], as any scalar.
template <Scalar S>
S decoded(const S& byte, const S& multiplier) {
  return multiplier * ((byte - S(kRealisZero)) * constant<S>(1.0 / 127));
}

// The byte whose coefficient is nearest to c [1/sr], in [1, 255]. What exceeds the multiplier becomes its end. 128 for
// NaN and for a multiplier that is not above 0.
// Error   decoded(encoded(c, m), m) is off by at most m / 254 where |c| <= m.
inline std::uint8_t encoded(double c, double multiplier) {
  const double x = c / multiplier * 127;
  if (!(multiplier > 0) || std::isnan(x)) return kRealisZero;
  return static_cast<std::uint8_t>(kRealisZero + std::lround(std::clamp(x, -127.0, 127.0)));
}

// The multiplier of a lobe [1/sr], found offline: the least that clips none of its coefficients, whose largest magnitude
// over all texels and channels is given [1/sr], as a float that is not below it. 0 for a lobe that no texel uses.
inline float multiplier_of(double largest) {
  const float rounded = static_cast<float>(largest);
  return rounded < largest ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

}  // namespace likeness::brdf
