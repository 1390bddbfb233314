#include "fit/report/sphere_pixels.h"

#include <cmath>
#include <numbers>

namespace likeness::fit {

std::vector<SpherePixel> lit_pixels(std::span<const double> lights_deg, int size) {
  using Vec3 = measured::Direction;
  const double radius = 0.48 * size;
  std::vector<SpherePixel> pixels;
  for (std::size_t light = 0; light < lights_deg.size(); ++light) {
    const double angle = lights_deg[light] * std::numbers::pi / 180;
    const Vec3 to_light{std::sin(angle), 0, std::cos(angle)};
    for (int row = 0; row < size; ++row) {
      for (int column = 0; column < size; ++column) {
        const double x = (column + 0.5 - size / 2.0) / radius, y = (size / 2.0 - row - 0.5) / radius;
        const double z2 = 1 - x * x - y * y;
        if (z2 <= 0) continue;
        const Vec3 normal{x, y, std::sqrt(z2)};
        const double cos_i = dot(normal, to_light);
        if (cos_i <= 0) continue;
        // A frame about the normal whose first axis is horizontal.
        const double length = std::sqrt(normal.z * normal.z + x * x);
        const Vec3 tangent{normal.z / length, 0, -x / length};
        const Vec3 bitangent{y * tangent.z, normal.z * tangent.x - x * tangent.z, -y * tangent.x};
        pixels.push_back({static_cast<int>(light) * size + column, row,
                          Vec3{dot(to_light, tangent), dot(to_light, bitangent), cos_i},
                          Vec3{tangent.z, bitangent.z, normal.z}});
      }
    }
  }
  return pixels;
}

}  // namespace likeness::fit
