#pragma once

#include "brdf/scalar.h"

namespace likeness::brdf {

// scale exp(-x), x >= 0, from two halves of the exponential: what is above the least float stays so, although exp(-x)
// alone is not.
template <Scalar S>
S scaled_exp(const S& scale, const S& x) {
  const S half = exp(S(S(-0.5) * x));
  return scale * half * half;
}

}  // namespace likeness::brdf
