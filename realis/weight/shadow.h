#pragma once

#include "realis/weight/samples.h"

namespace likeness::realis::weight {

// Falls between the contour of a shadow in the photograph and that of the same shadow in the render, with the width of the gap
// (spec: Realis, Bake, 3): the residual there is of a caster or a camera that is a little elsewhere.
//
// Visibility v is the picture over what the texel shows where it is lit (75th percentile over its lights) under this light's
// cosine; a contour is where v crosses a half within two pixels, and has the sign of the crossing. From every texel one looks
// along rows, columns and both diagonals: where the nearest contour on one side is the photo's and on the other the render's,
// with the same sign (both sides grow lighter the same way: the dot product of their gradients is positive), at most `longest`
// pixels apart, the texel is between the two: 1 - clamp01((gap - 0.1) / (full - 0.1)), the least of the four ways.
// A contour that is hidden where the known part of a line ends counts as being there, under lights whose render has shadows.
// Lines are walked once from end to end, so that the cost does not depend on `longest`. Without contours of both kinds
// (a render from normals casts no shadow) nothing is between, and the weight is 1.
struct ShadowSettings {
  double full = 1;      // gap [pixel] at which nothing is trusted, > 0.1
  double longest = 24;  // widest gap [pixel]
};
Weights shadow(const Samples& s, const ShadowSettings& settings);

// The same of one light, for who does not hold them all: v of both pictures, row by row, NaN where it is not known (outside
// the subject, and where the light's cosine is at most kLeastShadowCosine). Of each pixel.
std::vector<float> shadow_of_light(int width, int height, std::span<const float> photo, std::span<const float> render,
                                   const ShadowSettings& settings);
inline constexpr double kLeastShadowCosine = 0.08;  // below it a shading's own end is steeper than a contour
inline constexpr double kLitShare = 0.75;  // of a texel's lights: the one that says what it shows where it is lit

}  // namespace likeness::realis::weight
