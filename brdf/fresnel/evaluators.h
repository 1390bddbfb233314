#pragma once

#include "brdf/evaluator.h"

// What brdf/fresnel computes, as rows of `likeness eval`.
namespace likeness::brdf {

using FresnelEvaluators = std::tuple<>;

}  // namespace likeness::brdf
