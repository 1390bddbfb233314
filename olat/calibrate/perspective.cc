#include "olat/calibrate/perspective.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/QR>

namespace likeness::olat_calibrate {

Perspective perspective_of(std::span<const Point> plane, std::span<const Point> picture) {
  const auto count = static_cast<Eigen::Index>(plane.size());
  Eigen::MatrixXd equations(2 * count, 8);
  Eigen::VectorXd right(2 * count);
  // In units of the largest coordinate, so that no column outweighs another.
  double unit = 1;
  for (const Point& p : picture) unit = std::max({unit, std::abs(p[0]), std::abs(p[1])});
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto [x, y] = plane[static_cast<std::size_t>(i)];
    const double u = picture[static_cast<std::size_t>(i)][0] / unit, v = picture[static_cast<std::size_t>(i)][1] / unit;
    equations.row(2 * i) << x, y, 1, 0, 0, 0, -u * x, -u * y;
    equations.row(2 * i + 1) << 0, 0, 0, x, y, 1, -v * x, -v * y;
    right[2 * i] = u;
    right[2 * i + 1] = v;
  }
  const Eigen::VectorXd h = equations.colPivHouseholderQr().solve(right);
  Perspective out;
  for (int i = 0; i < 8; ++i) out.h[static_cast<std::size_t>(i)] = i < 6 ? unit * h[i] : h[i];
  return out;
}

}  // namespace likeness::olat_calibrate
