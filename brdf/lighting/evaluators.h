#pragma once

#include "brdf/lighting/harmonics_evaluators.h"
#include "brdf/lighting/spherical_gaussian_evaluators.h"
#include "brdf/lighting/tone_evaluators.h"

// What brdf/lighting computes, as rows of `likeness eval`.
namespace likeness::brdf {

using LightingEvaluators =
    std::tuple<PlainSphericalGaussian, WindowedSphericalGaussian, SphericalGaussianProduct, ShValue, ShBasis, ShRotated,
               ShCompressed, Tonemap, TonemapTable, TonemapInverse, ExposureZone>;

}  // namespace likeness::brdf
