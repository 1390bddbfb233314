#pragma once

#include "fit/capture/capture_fit.h"
#include "realis/subject.h"

// What a fit does not know of the night side: how softly light ends there, and what comes back from the surroundings. Both
// are two numbers of an asset, and cost a texel nothing.
namespace likeness::realis {

// Subject::facing of a fit.
void face(Subject& subject, const capture_fit::Fit& fit);

struct Terminator {
  double spread = 0;  // capture_fit::Fit::spread: nearest to the photographs in stops, near the horizon of the light
  double least = 0;   // capture_fit::Fit::least: the median of texels that the light is behind; of fewer than 100, 0
};

// From the photographs of the subject, whose renders have neither. Both are 0 where `facing` or cosines are not known.
Terminator terminator_of(const Subject& subject);

// The renders with it.
void soften(Subject& subject, const Terminator& terminator);

}  // namespace likeness::realis
