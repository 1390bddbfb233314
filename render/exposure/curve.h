#pragma once

#include <array>

#include "brdf/lighting/gt_tonemap.h"
#include "render/scene/scene.h"

// The live curve: what a view does to greys, as numbers of light after exposure.
namespace likeness::exposure {

struct Curve {
  double toe_end = 0;         // below it the curve is its toe; 0: it has none
  double shoulder_start = 0;  // above it, its shoulder
  double crushed_below = 0;   // a grey below it is written as code 0; 0: none is
  double clipped_from = 0;    // a grey at or above it has a channel of code 255; infinity: none has
};

// Of a view; its `ev` is left out of account. Throws as view::Shower does. Borders of codes are found to a float's last bit, for
// views whose codes never fall where light rises; of others they are the last border from below of code 0, and the last to
// 255.
Curve curve_of(const scene::View& view, const brdf::GtTonemap<double>& gt = {});

// Its toe_end and shoulder_start alone. Of gt its own m and S0; of other views where the slope of display light against scene
// light, both as logarithms, leaves what it is at middle grey by a factor of 1.5.
std::array<double, 2> curve_limits(const scene::View& view, const brdf::GtTonemap<double>& gt = {});

// In the view's own precision.
brdf::GtTonemap<float> float_curve(const brdf::GtTonemap<double>& gt);

}  // namespace likeness::exposure
