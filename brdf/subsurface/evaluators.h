#pragma once

#include "brdf/evaluator.h"

// What brdf/subsurface computes, as rows of `likeness eval`.
namespace likeness::brdf {

using SubsurfaceEvaluators = std::tuple<>;

}  // namespace likeness::brdf
