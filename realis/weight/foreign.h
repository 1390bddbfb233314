#pragma once

#include "realis/weight/samples.h"

namespace likeness::realis::weight {

// 0 where something that is no part of the subject was before the camera under one light: a hand, a cable, a fly. A sample
// is off if, over the light received,
//   its residual is above that of the 5 nearest lights and of most others, or below it (but not as dark as a shadow), by
//   more than `share` of what the texel shows where it is lit and `deviations` times what near lights differ by; or
//   its color is another than the texel's by `share` (red or blue over luminance), not only whiter as a highlight is.
// Between what neighbouring lights show anything may be: each of them may be in a shadow. Within 30 degrees of the mirror
// direction only color counts, because renders are off there by highlights; where light grazes or does not reach, four times
// the limits. A region of at least `least` such pixels (neighbours in the picture, of the same light), with all that touches
// it and is off by 0.3 times as much, is an object, with a rim of a pixel. It needs four lights.
struct ForeignSettings {
  double deviations = 6;  // > 0
  double share = 0.25;    // of the texel's median, > 0
  double least = 9;       // pixels
};
Weights foreign(const Samples& s, const ForeignSettings& settings);

}  // namespace likeness::realis::weight
