#pragma once

namespace likeness::sampling {

// The weight of what was found with density p > 0 and could have been found with density q: p^2 / (p^2 + q^2), written so
// that neither square overflows to NaN.
// Source  Veach and Guibas 1995, "Optimally Combining Sampling Techniques": the power heuristic, exponent 2.
inline float power_heuristic(float p, float q) {
  const float ratio = q / p;
  return 1 / (1 + ratio * ratio);
}

}  // namespace likeness::sampling
