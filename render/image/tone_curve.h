#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "render/image/picture.h"

// The sRGB transfer curve, IEC 61966-2-1, in its exact piecewise form (a line below 0.0031308, a power of 2.4
// above), and the way of a linear picture to the display: exposure, then this curve.
namespace likeness::image {

// Linear light [1] to display value [1]; continued through 0 with odd symmetry, not clamped.
inline double srgb_encode(double linear) {
  const double x = std::abs(linear);
  const double y = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return std::copysign(y, linear);
}

// Display value [1] to linear light [1], the inverse of srgb_encode (to 4e-8 at the joint, as the standard has it).
inline double srgb_decode(double display) {
  const double y = std::abs(display);
  const double x = y <= 0.04045 ? y / 12.92 : std::pow((y + 0.055) / 1.055, 2.4);
  return std::copysign(x, display);
}

// The linear light [1] of an 8-bit display value.
inline double srgb_decode8(std::uint8_t display) { return srgb_decode(display / 255.0); }

namespace detail {

// thresholds[k]: the smallest float whose encoded value rounds to k or more.
inline const std::array<float, 256>& srgb_thresholds() {
  static const std::array<float, 256> kTable = [] {
    std::array<float, 256> table{};
    for (std::size_t k = 1; k < 256; ++k) {
      // Positive floats are ordered as their bits are: bisect the bits.
      std::uint32_t low = 0, high = std::bit_cast<std::uint32_t>(1.0f);
      while (low < high) {
        const std::uint32_t middle = low + (high - low) / 2;
        if (255.0 * srgb_encode(std::bit_cast<float>(middle)) + 0.5 >= static_cast<double>(k)) high = middle;
        else low = middle + 1;
      }
      table[k] = std::bit_cast<float>(low);
    }
    return table;
  }();
  return kTable;
}

}  // namespace detail

// Linear light [1], clamped to [0, 1], to the nearest 8-bit display value; NaN gives 0. Equal to rounding
// 255 srgb_encode(x), at the price of eight comparisons.
inline std::uint8_t srgb_encode8(float linear) {
  const std::array<float, 256>& table = detail::srgb_thresholds();
  std::size_t at = 0;
  for (std::size_t step = 128; step > 0; step /= 2)
    if (linear >= table[at + step]) at += step;
  return static_cast<std::uint8_t>(at);
}

// The picture as a display shows it, after exposure by `ev` stops.
inline DisplayPicture display(const Picture& picture, double ev = 0) {
  DisplayPicture out(picture.width, picture.height);
  const float scale = static_cast<float>(std::exp2(ev));
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) out.rgb[i] = srgb_encode8(picture.rgb[i] * scale);
  return out;
}

}  // namespace likeness::image
