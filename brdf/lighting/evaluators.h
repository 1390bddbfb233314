#pragma once

#include "brdf/evaluator.h"

// What brdf/lighting computes, as rows of `likeness eval`.
namespace likeness::brdf {

using LightingEvaluators = std::tuple<>;

}  // namespace likeness::brdf
