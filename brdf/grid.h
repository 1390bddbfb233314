#pragma once

#include <array>
#include <cstddef>

#include "brdf/scalar.h"

namespace likeness::brdf {

// A table over three axes with several values at each point, and its lookup between them.
//
// Coordinates run from 0 to 1 along each axis, first to last point; what an axis stands for is its maker's to state.
// Outside they count as the nearest end, NaN as 0.
template <std::size_t kX, std::size_t kY, std::size_t kZ, std::size_t kValues>
struct Grid {
  static constexpr std::array<std::size_t, 3> kPoints{kX, kY, kZ};
  std::array<float, kX * kY * kZ * kValues> data;

  static constexpr std::size_t index(std::size_t x, std::size_t y, std::size_t z) {
    return ((z * kY + y) * kX + x) * kValues;
  }
  // The coordinate of a point of an axis.
  static constexpr double coordinate(int axis, std::size_t point) {
    return double(point) / double(kPoints[std::size_t(axis)] - 1);
  }

  // All values at (x, y, z), linear along each axis.
  template <Scalar S>
  void lookup(const S& x, const S& y, const S& z, S* out) const {
    const Place<S> px(x, kX), py(y, kY), pz(z, kZ);
    for (std::size_t k = 0; k < kValues; ++k) out[k] = S(0.0);
    for (int corner = 0; corner < 8; ++corner) {
      const bool up_x = corner & 1, up_y = corner & 2, up_z = corner & 4;
      const S weight = (up_x ? px.above : px.below) * (up_y ? py.above : py.below) * (up_z ? pz.above : pz.below);
      const S cx = up_x ? px.next : px.first, cy = up_y ? py.next : py.first, cz = up_z ? pz.next : pz.first;
      const S at_corner =
          ((cz * constant<S>(double(kY)) + cy) * constant<S>(double(kX)) + cx) * constant<S>(double(kValues));
      for (std::size_t k = 0; k < kValues; ++k)
        out[k] = out[k] + weight * at(data.data(), S(at_corner + constant<S>(double(k))));
    }
  }

 private:
  // Between which two points of an axis a coordinate lies, and how much each of them counts.
  template <Scalar S>
  struct Place {
    S first, next, below, above;
    Place(const S& coordinate, std::size_t points) {
      const S position = clamp01(coordinate) * constant<S>(double(points - 1));
      first = smaller(S(floor(position)), constant<S>(double(points - 2)));
      next = first + S(1);
      above = position - first;
      below = S(1) - above;
    }
  };
  // Indices have to be whole numbers in a float.
  static_assert(kX * kY * kZ * kValues < (std::size_t(1) << 24));
};

}  // namespace likeness::brdf
