#pragma once

// Realis at run time: what a baked residual adds to the shading of a texel.
//
//     e(omega_i) = sum_k c_k G_k(M omega_i)                                                       [1/sr]
//     seen       = L max(f cos_i + w e max(cos_i, c0), 0)
//
// G_k       windowed spherical Gaussians that all texels of an asset share, in model space: lobes.h
// c_k       coefficients, eight of them a texel in a byte each, or all of them in floats: coefficient.h, texel.h
// M, c0     the way into model space, and the floor under the cosine that the bake divided by: shade.h
// w         1 where the surface still is what was baked, 0 where it is not: fade.h
//
// jitter.h takes a few lobes a frame in place of all; texels.h (not included here, it needs xsimd) many texels at once.
//
// Source    "The Rendering of The Callisto Protocol", Realis. The talk gives no formulas; the project's are
//           docs/models/realis.md's.
// Does not  depend on the view: what a residual holds of highlights is their mean over the cameras of the bake.
#include "brdf/realis/coefficient.h"
#include "brdf/realis/fade.h"
#include "brdf/realis/jitter.h"
#include "brdf/realis/lobes.h"
#include "brdf/realis/shade.h"
#include "brdf/realis/texel.h"
