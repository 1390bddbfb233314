#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "render/image/picture.h"

// How much brighter a photo is than its render, and how their tones bend. Both ask where the two agree up to one number
// and leave out what does not: shadows and highlights that only one of them has.
namespace likeness::registration {

struct Gain {
  std::array<double, 3> stops{};  // of each channel: the render times 2^stops is the photo [stop]
  double all = 0;                 // of the three together [stop]
  double scatter = 0;             // of the ratio about it, in pixels that count, from the noise and from the render [1]
  double sigma = 0;               // of `all` [stop], if neighbours are independent
  std::size_t pixels = 0;         // that count; 0: not measured
};

// The ratio of light, by Tukey's weights about the median ratio. A pixel counts if the render is above 10 `noise` (by
// the photo's noise a pixel must not be chosen: that would keep the bright ones). Pictures of one size, a weight for each
// pixel or none, noise >= 0, else std::invalid_argument.
Gain gain_between(const image::Picture& photo, const image::Picture& render, std::span<const float> weight,
                  std::array<double, 3> noise);

struct Curve {
  double exponent =
      1;  // photo ~ render^exponent: 1 linear; 0.4 to 0.5 sRGB values that were not decoded; 2.2 decoded twice
  double sigma = 0;        // [1], if every hundredth pixel is independent
  std::size_t pixels = 0;  // that count; 0: too few, or all of one tone
};

// The slope of log photo over log render, of luminance, with the same weights: a power law is what a forgotten or a
// repeated transfer curve looks like. Noise counts as in gain_between. `render` may be a prediction, such as the cosine.
Curve curve_between(const image::Picture& photo, const image::Picture& render, std::span<const float> weight,
                    double noise);

}  // namespace likeness::registration
