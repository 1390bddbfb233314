#pragma once

#include "brdf/evaluator.h"

// What brdf/diffuse computes, as rows of `likeness eval`.
namespace likeness::brdf {

using DiffuseEvaluators = std::tuple<>;

}  // namespace likeness::brdf
