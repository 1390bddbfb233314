#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "brdf/realis/lobes.h"
#include "brdf/realis/octahedron.h"

// Mixes of lobes, of which all texels of an asset have coefficients: what the residuals of an asset have in common.
namespace likeness::brdf {

// e(v) = sum_j c_j M_j(v) [1/sr], M_j = sum_k mix[j][k] G_k. Texels store a byte a mix and channel; `decoded` says what it
// is worth. M is a table on the octahedron: a light's direction costs three look-ups whatever the number of lobes, and a
// texel one multiply-add a mix.
// Error   of the table, of lobes of sharpness s: at most s h^2 of a mix's sum of |mix|, h = 2 / (side - 1); the side makes
//         that 1 % or less, as far as memory allows.
struct RealisMixes {
  static constexpr std::size_t kMost = 64;              // mixes
  static constexpr std::size_t kMostValues = 1u << 24;  // of the table
  static constexpr int kMostSide = 1025;

  std::size_t count = 0;
  Octahedron places;
  std::vector<float> values;                        // place by place, the mixes
  std::array<std::array<float, kMost>, 3> scale{};  // channel by channel: what the largest byte stands for [1/sr]
  std::array<float, 256> decoded{};                 // of a byte, [-1, 1]

  // Of the lobes' axes (unit), sharpnesses, and factors (mix by mix, the lobes; at most kMost mixes).
  void place(std::span<const Vec3<double>> axes, std::span<const double> sharpnesses, std::span<const double> mix) {
    const std::size_t lobes = axes.size();
    count = lobes > 0 ? mix.size() / lobes : 0;
    if (count == 0) return;
    places.side = side_for(sharpnesses, count);
    values.assign(places.count() * count, 0.0f);
    for (int y = 0; y < places.side; ++y)
      for (int x = 0; x < places.side; ++x) {
        const Vec3<double> v(places.direction(x, y));
        float* const out = values.data() + static_cast<std::size_t>(y * places.side + x) * count;
        std::array<double, kMost> sums{};
        for (std::size_t k = 0; k < lobes; ++k) {
          WindowedGaussian<double> lobe;
          lobe.plain.sharpness = sharpnesses[k];
          const double g = lobe.eval(versine_between(axes[k], v));
          if (!(g > 0)) continue;
          for (std::size_t j = 0; j < count; ++j) sums[j] += mix[j * lobes + k] * g;
        }
        for (std::size_t j = 0; j < count; ++j) out[j] = static_cast<float>(sums[j]);
      }
  }

  // scale M of all mixes towards a direction of the lobes' space, channel by channel.
  using Towards = std::array<std::array<float, kMost>, 3>;
  void towards(const Vec3<float>& direction, std::size_t channels, Towards& out) const {
    const Octahedron::Three near = places.about(direction);
    std::array<float, kMost> m{};
    for (std::size_t i = 0; i < 3; ++i) {
      const float* const from = values.data() + near.places[i] * count;
      for (std::size_t j = 0; j < count; ++j) m[j] += near.shares[i] * from[j];
    }
    for (std::size_t c = 0; c < channels; ++c)
      for (std::size_t j = 0; j < count; ++j) out[c][j] = scale[c][j] * m[j];
  }

  // A channel of a texel: its `count` bytes.
  float eval(const std::array<float, kMost>& towards, const std::uint8_t* bytes) const {
    float sum = 0;
    for (std::size_t j = 0; j < count; ++j) sum += decoded[bytes[j]] * towards[j];
    return sum;
  }

 private:
  static int side_for(std::span<const double> sharpnesses, std::size_t count) {
    double most = 1;
    for (const double s : sharpnesses) most = std::max(most, s);
    const double fits = std::sqrt(static_cast<double>(kMostValues / count));
    const double side = std::min({20 * std::sqrt(most) + 2, fits - 1, double{kMostSide} - 1});
    return 2 * static_cast<int>(side / 2) + 1;
  }
};

}  // namespace likeness::brdf
