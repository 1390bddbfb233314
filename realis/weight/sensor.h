#pragma once

#include "realis/weight/samples.h"

namespace likeness::realis::weight {

// 0 where a channel of the photograph is at or above `clip` [unit of the photo], or is not finite. Readers that know where each
// frame was full have marked those samples already; this one is for a level that no file states.
struct ClippedSettings {
  double clip = 1e30;
};
Weights clipped(const Samples& s, const ClippedSettings& settings);

// 0 where light was lost. A sensor that does not see less than some light [unit of the photo] says 0 for all of it: a
// channel that is below that level in the photo weighs 0 if the render is below 1.5 times it, too, and 1 from 3 times
// on. A shadow that the render lacks is dark in the photo only, and stays: it is what the bake is for. Without a level of
// its own one is found, if a thousandth of the samples that the render lights is exactly 0: the least values above it.
// A pixel that is exactly 0 under every light, among pixels of which half are not, is dead, and weighs 0.
struct BlackSettings {
  double level = 0;  // 0: found
};
Weights black(const Samples& s, const BlackSettings& settings);

}  // namespace likeness::realis::weight
