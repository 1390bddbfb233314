#pragma once

#include <span>
#include <vector>

#include "fit/measured/measured.h"

namespace likeness::fit {

// A pixel of a row of spheres that its light reaches: where it is, and its directions in the surface's own frame.
struct SpherePixel {
  int column, row;
  measured::Direction to_light, to_view;
};

// The lit pixels of spheres side by side, one a light, seen by an orthographic camera. lights_deg: angle between the
// directions to the camera and to the light, the light to the right. size: width and height of one sphere [pixels].
std::vector<SpherePixel> lit_pixels(std::span<const double> lights_deg, int size);

}  // namespace likeness::fit
