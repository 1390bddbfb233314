#pragma once

#include <array>

#include "render/image/picture.h"

// What a photo holds where there is no light: noise, and a level that should be 0.
namespace likeness::registration {

struct Darkness {
  std::array<double, 3> noise{};   // standard deviation of a pixel [the photo's unit]; 0: no noise, or cut off at black
  std::array<double, 3> level{};   // median
  std::array<double, 3> bright{};  // 99th percentile of the whole photo, to compare with
};

// Of the darkest fifth of the photo, by smoothed light, and what is as dark. Noise is read from second differences, which do not
// see a slope (Immerkaer, "Fast Noise Variance Estimation", 1996, with the median for the mean). What is not finite is
// left out. A photo of less than 8 x 8 pixels has none.
Darkness darkness_of(const image::Picture& photo);

}  // namespace likeness::registration
