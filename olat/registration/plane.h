#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/image/picture.h"

// One channel of light, and what the measurements of this room do with it first.
namespace likeness::registration {

struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;  // row by row from the top left

  Plane() = default;
  Plane(int width_, int height_)
      : width(width_), height(height_), values(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}
  float& at(int x, int y) { return values[index(x, y)]; }
  float at(int x, int y) const { return values[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

// Relative luminance of Rec. 709 light; what is not finite is 0.
Plane luminance(const image::Picture& picture);

// A Gaussian of standard deviation `sigma` pixels, cut at 3 sigma; the edge goes on as its pixels.
Plane blurred(const Plane& plane, float sigma);

// Half the size: the mean of each 2 x 2. An odd last row or column is left out.
Plane halved(const Plane& plane);

// The mean of what weighs more than 0, weighted; 0 if nothing does.
double weighted_mean(const Plane& plane, std::span<const float> weight);

// The smallest value that a share of all is at most (nearest rank); 0 for none. Reorders.
float quantile(std::vector<float>& values, double share);

// Throws std::invalid_argument if the pictures, or the weights where there are any, differ in size.
void require_one_size(const image::Picture& photo, const image::Picture& render, std::span<const float> weight);

}  // namespace likeness::registration
