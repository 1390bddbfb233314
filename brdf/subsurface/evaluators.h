#pragma once

#include "brdf/subsurface/diffusion_evaluators.h"
#include "brdf/subsurface/filter_evaluators.h"
#include "brdf/subsurface/walk_evaluators.h"

// What brdf/subsurface computes, as rows of `likeness eval`.
namespace likeness::brdf {

using SubsurfaceEvaluators =
    std::tuple<BurleyProfile, BurleyCdf, BurleyIcdf, BurleyIcdfHalley, BurleyIcdfHalleySteps<1>,
               BurleyIcdfHalleySteps<2>, BurleyIcdfHalleySteps<3>, BurleyIcdfHalleySteps<4>, BurleyShape,
               GaussianProfile, GaussianProfileOf<1>, GaussianProfileOf<2>, GaussianProfileOf<4>, BurleyDiskSample,
               SlabTransmission, ThinTranslucency, ThickTranslucency, BilateralWeightRow, RandomWalkProfile,
               RandomWalkAlbedo>;

}  // namespace likeness::brdf
