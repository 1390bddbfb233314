#pragma once

#include "realis/weight/samples.h"

namespace likeness::realis::weight {

// 0 where something that is no part of the subject was before the camera under one light: a hand, a cable, a fly. A sample is
// off if its residual over the light received differs from the median of the 5 nearest lights by more than `deviations` times
// what the texel's lights usually differ by, and, as light, by more than `share` of what the texel usually shows. A region of
// at least `least` such pixels (neighbours in the picture, of the same light), with all that touches it and is off by 0.3
// times as much, is an object, with a rim of a pixel, unless most of it
// is brighter within 25 degrees of the mirror direction: that is a highlight. What is darker than a fourth of the prediction is
// a cast shadow, and no object.
struct ForeignSettings {
  double deviations = 6;  // > 0
  double share = 0.25;    // of the texel's median, > 0
  double least = 9;       // pixels
};
Weights foreign(const Samples& s, const ForeignSettings& settings);

}  // namespace likeness::realis::weight
