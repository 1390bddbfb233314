#include "olat/calibrate/chrome.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace likeness::olat_calibrate {
namespace {

constexpr std::size_t kFewest = 100;  // pixels of a ball
constexpr double kSpot = 0.2;         // a spot reaches so far from its brightest pixel, of the radius
constexpr double kRim = 0.97;         // of the radius: farther out a reflection is a line

double luminance(const image::Picture& photo, int x, int y) {
  const auto p = photo.at(x, y);
  return 0.2126 * static_cast<double>(p[0]) + 0.7152 * static_cast<double>(p[1]) + 0.0722 * static_cast<double>(p[2]);
}

// From the ball to the viewer, in the camera's axes: the way back along the pixel's ray.
glm::dvec3 to_viewer(const capture::Camera& camera, double x, double y) {
  const glm::dmat3& k = camera.intrinsics;
  if (camera.is_orthographic || !(k[0][0] > 1) || !(k[1][1] > 1)) return {0, 0, -1};
  return -glm::normalize(glm::dvec3((x - k[2][0]) / k[0][0], (y - k[2][1]) / k[1][1], 1));
}

}  // namespace

std::optional<Ball> ball_of(const std::vector<std::uint8_t>& mask, int width, int height) {
  double x = 0, y = 0;
  std::size_t count = 0;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      if (mask[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)] !=
          0) {
        x += column + 0.5;
        y += row + 0.5;
        ++count;
      }
  if (count < kFewest) return {};
  const auto n = static_cast<double>(count);
  return Ball{x / n, y / n, std::sqrt(n / std::numbers::pi)};
}

std::optional<std::array<double, 3>> direction_of(const image::Picture& photo, const Ball& ball,
                                                  const capture::Camera& camera) {
  const auto inside = [&](int x, int y, double radius) {
    return std::hypot(x + 0.5 - ball.x, y + 0.5 - ball.y) <= radius * ball.radius;
  };
  // The brightest 3 x 3, since a single pixel may be hot.
  double brightest = 0;
  int top_x = 0, top_y = 0;
  for (int y = 1; y < photo.height - 1; ++y)
    for (int x = 1; x < photo.width - 1; ++x) {
      if (!inside(x, y, kRim)) continue;
      double sum = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) sum += luminance(photo, x + i, y + j);
      if (sum > brightest) brightest = sum, top_x = x, top_y = y;
    }
  brightest /= 9;
  if (!(brightest > 0)) return {};
  if (std::hypot(top_x + 0.5 - ball.x, top_y + 0.5 - ball.y) > kRim * ball.radius) return {};
  // The ball's outline is seen about the ray to its middle; so is its normal. The mean is of directions: a pixel of the
  // ball sees the same solid angle wherever it is, so a lamp that is wide is not drawn towards the rim.
  const glm::dvec3 axis = to_viewer(camera, ball.x, ball.y);
  const glm::dvec3 right = glm::normalize(glm::dvec3(1, 0, 0) - axis * axis.x), down = glm::cross(right, axis);
  glm::dvec3 sum(0);
  const int reach = static_cast<int>(std::ceil(kSpot * ball.radius));
  for (int row = std::max(0, top_y - reach); row <= std::min(photo.height - 1, top_y + reach); ++row)
    for (int column = std::max(0, top_x - reach); column <= std::min(photo.width - 1, top_x + reach); ++column) {
      if (std::hypot(column - top_x, row - top_y) > reach) continue;
      const double weight = luminance(photo, column, row) - 0.5 * brightest;
      const double nx = (column + 0.5 - ball.x) / ball.radius, ny = (row + 0.5 - ball.y) / ball.radius;
      const double square = nx * nx + ny * ny;
      if (!(weight > 0) || square >= 1) continue;
      const glm::dvec3 viewer = to_viewer(camera, column + 0.5, row + 0.5);
      const glm::dvec3 normal = nx * right + ny * down + std::sqrt(1 - square) * axis;
      sum += weight * (2 * glm::dot(normal, viewer) * normal - viewer);
    }
  if (!(glm::length(sum) > 0)) return {};
  const glm::dvec3 world = glm::normalize(glm::dmat3(camera.world_from_camera) * sum);
  return std::array{world.x, world.y, world.z};
}

}  // namespace likeness::olat_calibrate
