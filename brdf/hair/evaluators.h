#pragma once

#include "brdf/evaluator.h"

// What brdf/hair computes, as rows of `likeness eval`.
namespace likeness::brdf {

using HairEvaluators = std::tuple<>;

}  // namespace likeness::brdf
