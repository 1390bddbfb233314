#pragma once

#include <cmath>
#include <concepts>
#include <numbers>

namespace likeness::brdf {

// What the mean of max(x, 0) is above max(cosine, 0), for x spread normally about the cosine: light does not end at a line where
// the normals of a pixel's surface differ, or are known that well only. `spread` is x's standard deviation, >= 0; 0: none.
// In [0, spread / sqrt(2 pi)], largest at the horizon, and even in the cosine.
template <std::floating_point T>
T beyond_hard(T cosine, T spread) {
  if (!(spread > 0)) return 0;
  const T z = std::abs(cosine) / spread;
  return spread * (std::exp(T(-0.5) * z * z) * (std::numbers::inv_sqrtpi_v<T> / std::numbers::sqrt2_v<T>)-T(0.5) * z *
                   std::erfc(z / std::numbers::sqrt2_v<T>));
}

}  // namespace likeness::brdf
