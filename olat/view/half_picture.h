#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/image/picture.h"

// A picture as the viewer's textures hold it: RGBA in half floats, row by row from the top left. RGB is linear light,
// what is beyond +-65504 limited to that and NaN 0; A is the bits of capture::Flaw as a whole number, which a half holds
// exactly.
namespace likeness::olat_view {

struct HalfPicture {
  int width = 0, height = 0;
  std::vector<std::uint16_t> rgba;

  std::size_t bytes() const { return rgba.size() * sizeof(std::uint16_t); }
};

// `flaws` is empty, or a byte for each pixel.
HalfPicture half_of(const image::Picture& picture, std::span<const std::uint8_t> flaws);

// One value a pixel, in R.
HalfPicture half_of_map(int width, int height, std::span<const float> values);

// Half as large (rounded up): means of light over 2 x 2 pixels, and all of their flaws but the mask, which has to hold for
// all four.
HalfPicture halved(const HalfPicture& picture);

// Light and flaws again.
image::Picture light_of(const HalfPicture& picture);
std::vector<std::uint8_t> flaws_of(const HalfPicture& picture);

}  // namespace likeness::olat_view
