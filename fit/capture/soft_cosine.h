#pragma once

#include <cmath>
#include <numbers>

namespace likeness::capture_fit {

// What the mean of max(x, 0) is above max(cosine, 0), for x spread normally about the cosine: light does not end at a line where
// the normals of a pixel's surface differ, or are known that well only. `spread` is x's standard deviation, >= 0; 0: none.
// In [0, spread / sqrt(2 pi)], largest at the horizon, and even in the cosine.
inline double beyond_hard(double cosine, double spread) {
  if (!(spread > 0)) return 0;
  const double z = std::abs(cosine) / spread;
  return spread *
         (std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi) - 0.5 * z * std::erfc(z / std::numbers::sqrt2));
}

}  // namespace likeness::capture_fit
