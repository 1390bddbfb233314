#pragma once

#include <array>
#include <vector>

#include "render/image/picture.h"

namespace likeness::bloom {

// A square part of a picture about a source of light, as rings about the source's centroid: one pixel wide near it, 6 % of
// the radius farther out.
struct Rings {
  int left = 0, top = 0, side = 0;  // of the square in the picture; side = 2 radius + 1
  std::array<double, 2> center{};   // in the square, pixels
  std::vector<double> radius;       // of each ring, the mean of its pixels
  std::vector<int> of_pixel;        // the ring of each pixel of the square; -1: beyond, or not to be used

  std::size_t count() const { return radius.size(); }
};

// The values of a ring's pixels that are used.
struct RingMeans {
  std::vector<double> mean, deviation, pixels;  // deviation of one pixel; how many pixels
};

// The centroid is that of what is brighter than a hundredth of the brightest pixel. `radius` 0: as far as the picture's
// nearest edge, at most 256. Throws std::invalid_argument if the source is black or nearer than 4 pixels to an edge.
Rings rings_about(const image::Picture& source, int radius);

RingMeans means_of(const Rings& rings, const std::vector<double>& square);

// The square's part of a channel; what is not finite is 0.
std::vector<double> square_of(const Rings& rings, const image::Picture& picture, std::size_t channel);

}  // namespace likeness::bloom
