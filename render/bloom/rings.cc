#include "render/bloom/rings.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace likeness::bloom {
namespace {

constexpr int kLongestByDefault = 256, kLeastRadius = 4;

double brightness(const image::Picture& picture, int x, int y) {
  double sum = 0;
  for (const float value : picture.at(x, y))
    sum += std::isfinite(value) ? std::max(0.0, static_cast<double>(value)) : 0.0;
  return sum;
}

// The ring of a distance, as a number that grows with it.
int ring_number(double distance) {
  constexpr double kGrowth = 1.06, kFirstWide = 16;
  if (distance < kFirstWide) return static_cast<int>(distance + 0.5);
  return static_cast<int>(kFirstWide + 0.5) + static_cast<int>(std::log(distance / kFirstWide) / std::log(kGrowth));
}

}  // namespace

Rings rings_about(const image::Picture& source, int radius) {
  double brightest = 0, sum = 0, sum_x = 0, sum_y = 0;
  for (int y = 0; y < source.height; ++y)
    for (int x = 0; x < source.width; ++x) brightest = std::max(brightest, brightness(source, x, y));
  if (!(brightest > 0)) throw std::invalid_argument("is black: there is no source of light in it");
  for (int y = 0; y < source.height; ++y)
    for (int x = 0; x < source.width; ++x)
      if (const double b = brightness(source, x, y); b > 0.01 * brightest)
        sum += b / brightest, sum_x += x * (b / brightest), sum_y += y * (b / brightest);
  const double cx = sum_x / sum, cy = sum_y / sum;
  const int px = static_cast<int>(std::lround(cx)), py = static_cast<int>(std::lround(cy));
  const int room = std::min({px, py, source.width - 1 - px, source.height - 1 - py});
  const int used = radius > 0 ? std::min(radius, room) : std::min(kLongestByDefault, room);
  if (used < kLeastRadius)
    throw std::invalid_argument("has its source " + std::to_string(room) + " pixels from an edge; " +
                                std::to_string(kLeastRadius) + " are needed, and hundreds are better");
  Rings rings{px - used, py - used, 2 * used + 1, {cx - (px - used), cy - (py - used)}, {}, {}};
  rings.of_pixel.assign(static_cast<std::size_t>(rings.side) * static_cast<std::size_t>(rings.side), -1);
  std::vector<double> total, pixels;
  for (int y = 0; y < rings.side; ++y)
    for (int x = 0; x < rings.side; ++x) {
      const double distance = std::hypot(x - rings.center[0], y - rings.center[1]);
      if (distance > used) continue;
      const auto ring = static_cast<std::size_t>(ring_number(distance));
      if (ring >= total.size()) total.resize(ring + 1), pixels.resize(ring + 1);
      total[ring] += distance, ++pixels[ring];
      rings.of_pixel[static_cast<std::size_t>(y) * static_cast<std::size_t>(rings.side) + static_cast<std::size_t>(x)] =
          static_cast<int>(ring);
    }
  for (std::size_t i = 0; i < total.size(); ++i) rings.radius.push_back(pixels[i] > 0 ? total[i] / pixels[i] : 0);
  return rings;
}

RingMeans means_of(const Rings& rings, const std::vector<double>& square) {
  const std::size_t count = rings.count();
  RingMeans out{std::vector<double>(count), std::vector<double>(count), std::vector<double>(count)};
  for (std::size_t i = 0; i < square.size(); ++i)
    if (const int ring = rings.of_pixel[i]; ring >= 0)
      out.mean[static_cast<std::size_t>(ring)] += square[i], ++out.pixels[static_cast<std::size_t>(ring)];
  for (std::size_t i = 0; i < count; ++i)
    if (out.pixels[i] > 0) out.mean[i] /= out.pixels[i];
  for (std::size_t i = 0; i < square.size(); ++i)
    if (const int ring = rings.of_pixel[i]; ring >= 0)
      out.deviation[static_cast<std::size_t>(ring)] +=
          std::pow(square[i] - out.mean[static_cast<std::size_t>(ring)], 2);
  for (std::size_t i = 0; i < count; ++i)
    out.deviation[i] = std::sqrt(out.deviation[i] / std::max(1.0, out.pixels[i] - 1));
  return out;
}

std::vector<double> square_of(const Rings& rings, const image::Picture& picture, std::size_t channel) {
  std::vector<double> out;
  out.reserve(rings.of_pixel.size());
  for (int y = 0; y < rings.side; ++y)
    for (int x = 0; x < rings.side; ++x) {
      const auto value = static_cast<double>(picture.at(rings.left + x, rings.top + y)[channel]);
      out.push_back(std::isfinite(value) ? value : 0.0);
    }
  return out;
}

}  // namespace likeness::bloom
