#pragma once

#include <array>
#include <span>

namespace likeness::olat_calibrate {

using Point = std::array<double, 2>;

// u = (h0 x + h1 y + h2) / (h6 x + h7 y + 1), v likewise: how a plane is seen.
struct Perspective {
  std::array<double, 8> h{1, 0, 0, 0, 1, 0, 0, 0};
  Point operator()(double x, double y) const {
    const double w = h[6] * x + h[7] * y + 1;
    return {(h[0] * x + h[1] * y + h[2]) / w, (h[3] * x + h[4] * y + h[5]) / w};
  }
};

// With the least squares of u w - ..., v w - ... over at least four pairs of points of the plane and of the picture.
Perspective perspective_of(std::span<const Point> plane, std::span<const Point> picture);

}  // namespace likeness::olat_calibrate
