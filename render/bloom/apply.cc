#include "render/bloom/apply.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "render/bloom/fourier.h"

namespace likeness::bloom {
namespace {

constexpr float kLargestHalf = 65504;

float usable_light(float value) {
  if (std::isnan(value)) return 0;
  return std::isinf(value) ? std::copysign(kLargestHalf, value) : value;
}

// Where a coordinate beyond the edge is mirrored to; the edge itself is between two equal pixels.
int mirrored(int x, int size) {
  const int period = 2 * size;
  x = ((x % period) + period) % period;
  return x < size ? x : period - 1 - x;
}

// What is scattered in one channel, as a real spectrum (in the layout of transform()).
std::vector<double> spectrum_of(const Kernel& kernel, std::size_t channel, int size) {
  Square square(size);
  for (const Component& component : kernel.components)
    if (component.weight[channel] > 0)
      add_kernel(square, sampled(component.family, component.scale, kernel.radius), kernel.radius,
                 component.weight[channel]);
  transform(square, false);
  std::vector<double> out(square.at.size());
  std::transform(square.at.begin(), square.at.end(), out.begin(),
                 [](const std::complex<double>& v) { return v.real(); });
  return out;
}

struct Tiling {
  int size, step, across, down;  // of the transform; of what is new in a tile; how many
};

Tiling tiling_of(const image::Picture& picture, int radius) {
  const int longest = std::max(picture.width, picture.height);
  const int size = fast_size(std::min(std::max(2048, 3 * radius), longest + 2 * radius));
  const int step = size - 2 * radius;
  return {size, step, (picture.width + step - 1) / step, (picture.height + step - 1) / step};
}

}  // namespace

Applied apply(const image::Picture& picture, const Kernel& kernel, const ApplyOptions& options) {
  Applied out{image::Picture(picture.width, picture.height), 0, 0};
  bool is_negative = false;
  for (const float value : picture.rgb) {
    out.not_a_number += std::isnan(value) ? 1u : 0u;
    out.infinite += std::isinf(value) ? 1u : 0u;
    is_negative |= value < 0;
  }
  if (picture.rgb.empty()) return out;
  const int radius = kernel.radius;
  const Tiling tiling = tiling_of(picture, radius);
  const std::size_t tiles = static_cast<std::size_t>(tiling.across) * static_cast<std::size_t>(tiling.down),
                    pairs = (tiles + 1) / 2;
  std::mutex telling;
  std::size_t done = 0;

  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<double> spectrum = spectrum_of(kernel, c, tiling.size);
    const auto light_at = [&](int x, int y) -> double {
      if (options.edges == Edges::kReflect) x = mirrored(x, picture.width), y = mirrored(y, picture.height);
      else if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return 0;
      return static_cast<double>(usable_light(picture.at(x, y)[c]));
    };
    const auto corner = [&](std::size_t tile) {
      const int column = static_cast<int>(tile % static_cast<std::size_t>(tiling.across)),
                row = static_cast<int>(tile / static_cast<std::size_t>(tiling.across));
      return std::array<int, 2>{column * tiling.step, row * tiling.step};
    };
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pairs, 1), [&](const tbb::blocked_range<std::size_t>& range) {
      Square square(tiling.size);
      for (std::size_t pair = range.begin(); pair != range.end(); ++pair) {
        const std::size_t first = 2 * pair, second = 2 * pair + 1;
        const auto a = corner(first), b = corner(second);
        for (int y = 0; y < tiling.size; ++y)
          for (int x = 0; x < tiling.size; ++x)
            square(x, y) = {light_at(a[0] + x - radius, a[1] + y - radius),
                            second < tiles ? light_at(b[0] + x - radius, b[1] + y - radius) : 0.0};
        transform(square, false);
        for (std::size_t i = 0; i < square.at.size(); ++i) square.at[i] *= spectrum[i];
        transform(square, true);
        for (const std::size_t tile : {first, second}) {
          if (tile >= tiles) break;
          const auto at = corner(tile);
          for (int y = at[1]; y < std::min(at[1] + tiling.step, picture.height); ++y)
            for (int x = at[0]; x < std::min(at[0] + tiling.step, picture.width); ++x) {
              const std::complex<double>& scattered = square(x - at[0] + radius, y - at[1] + radius);
              double light = kernel.direct[c] * static_cast<double>(usable_light(picture.at(x, y)[c])) +
                             (tile == first ? scattered.real() : scattered.imag());
              if (!is_negative) light = std::max(light, 0.0);  // rounding of the transform
              constexpr double kMost = std::numeric_limits<float>::max();
              out.picture.at(x, y)[c] = static_cast<float>(std::clamp(light, -kMost, kMost));
            }
        }
        if (options.tell) {
          const std::lock_guard lock(telling);
          options.tell(static_cast<double>(++done) / static_cast<double>(3 * pairs));
        }
      }
    });
  }
  return out;
}

}  // namespace likeness::bloom
