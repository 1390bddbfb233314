#pragma once

#include "realis/weight/samples.h"

namespace likeness::realis::weight {

// Falls where a highlight is left in the photograph that the render lacks. The residual over the light received rises towards
// the mirror direction of the normal: its median over texels and lights in rings of 5 degrees of the half angle, above that of
// 45 degrees and more. If the first three rings do not rise above `significance` deviations of the rest, and above a hundredth
// of what the photographs show, there is no such light and the weight is 1. Within the rings that rise by half of t, a sample weighs
// 1 / (1 + (x / t)^2), x its excess over the median of its texel's other lights beyond 45 degrees, t half a deviation or that
// hundredth. Normals and views have to be known.
//
// Where samples were also photographed through crossed polarizers, the highlight is measured and not estimated: what parallel
// polarizers show less what crossed ones do, over the light received. x is then its excess over the median of its texel's lights
// (a gloss that is everywhere stays), t the larger of a hundredth of what the photographs show and of three deviations of the
// samples whose highlight is below that median; normals and views are not needed.
//
// Off unless asked for: a bake that is seen from its own camera may keep its highlights.
struct SpecularSettings {
  double significance = 3;  // deviations, > 0
};
Weights specular(const Samples& s, const SpecularSettings& settings);

// The half angle of light, view and normal as a cosine; -1 where one is not known. Of a sample.
double half_cosine(const Samples& s, std::size_t texel, std::size_t light);

}  // namespace likeness::realis::weight
