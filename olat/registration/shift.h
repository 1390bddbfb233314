#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "render/image/picture.h"

// How far a photo lies beside its render: what is at (u, v) in the render is at (u + x, v + y) in the photo.
//
// Found by Gauss-Newton on the logarithm of luminance, coarse to fine, with the gain of the pair as a third unknown, so
// that exposure does not matter; each step weighs pixels by how well they agree (Cauchy), so that shadows and highlights
// that only one picture has do not pull. Only what lies well inside the weights is looked at: their border is the
// photo's, and would hold the render in place. Finds shifts of up to 1/8 of the shorter side.
//
// An object without texture is measured by its shading, which one light shows in one direction only; combined() puts the
// lights of a camera together. Shading that the render gets wrong looks like a shift: the sigma grows with what does not
// agree, and with how the lights disagree.
namespace likeness::registration {

struct Shift {
  double x = 0, y = 0;  // [pixel]
  // Covariance of x and y [pixel^2]; infinite where nothing was measured.
  double xx = std::numeric_limits<double>::infinity(), xy = 0, yy = std::numeric_limits<double>::infinity();
  std::size_t pixels = 0;  // that were compared

  bool is_measured() const { return pixels > 0; }
  double sigma() const;   // of the worst direction [pixel]
  double length() const;  // [pixel]
};

// `noise` is the photo's noise about black, in its unit. Pictures of one size, and a weight for each pixel or none, else
// std::invalid_argument. Not measured: too little inside the weights, nothing but one tone, or no agreement.
Shift shift_between(const image::Picture& photo, const image::Picture& render, std::span<const float> weight,
                    double noise);

// The one shift of all pairs of a camera: the mean by what each knows, less of those that stand apart; its covariance is
// that of the mean, or of the scatter where that is larger.
Shift combined(std::span<const Shift> shifts);

}  // namespace likeness::registration
