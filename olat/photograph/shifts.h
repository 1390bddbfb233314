#pragma once

#include "render/photograph/merge.h"

namespace likeness::olat_photograph {

// How far frames of a bracket lie beside each other, by the measurement that finds photographs beside renders
// (olat/registration/shift.h).
photograph::ShiftFinder shift_finder();

}  // namespace likeness::olat_photograph
