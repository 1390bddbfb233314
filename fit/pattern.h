#pragma once

#include "fit/result/result.h"

namespace likeness::fit {

// The pattern of a fitted slice, after the talk's sorting of MERL: does the diffuse brighten or darken towards the
// Fresnel edge (top), the retroreflection edge (right), and is the corner between them dark?
//
// Each is the fitted diffuse's mean over a patch of the slice against its mean over the middle, in stops; less than a
// quarter of a stop either way is 'flat'. A material whose diffuse albedo there is below 0.001 is a group of its own.
Pattern pattern_of(const brdf::AnyBrdf& model);

}  // namespace likeness::fit
