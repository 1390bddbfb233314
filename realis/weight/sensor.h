#pragma once

#include "realis/weight/samples.h"

namespace likeness::realis::weight {

// 0 where a channel of the photograph is at or above `clip` [unit of the photo], or is not finite. Readers that know where each
// frame was full have marked those samples already; this one is for a level that no file states.
struct ClippedSettings {
  double clip = 1e30;
};
Weights clipped(const Samples& s, const ClippedSettings& settings);

// 0 where photograph and render are both nearly dark: the photo at most `level` times the light's brightest texels (99th
// percentile), the render at most 4 times as much. There a sensor has lost what a small residual would be of. A cast shadow
// that the render lacks is dark in the photo only, and stays: it is what the bake is for.
struct BlackSettings {
  double level = 0.01;
};
Weights black(const Samples& s, const BlackSettings& settings);

}  // namespace likeness::realis::weight
