#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "render/image/picture.h"

// Words in a picture, for those who look at a slice alone: its axes, and what lies where.
namespace likeness::fit {

// Capital letters, digits and . , + - = _ / ( ) of 5 x 7 pixels, six pixels apart; small letters become capitals, other
// characters blanks. `scale` enlarges by a whole number; `upwards` writes from the bottom to the top.
struct Lettering {
  std::array<std::uint8_t, 3> color{0, 0, 0};
  int scale = 1;
  bool upwards = false;
  bool outlined = false;  // in black, for words over a picture
};
void write_text(image::DisplayPicture& picture, int x, int y, std::string_view text, const Lettering& lettering);

// Width of a text as it is written [pixels].
int text_width(std::string_view text, int scale);

// The picture of a slice within axes: theta_h to the right, theta_d upwards, in degrees, `title` above them and the
// names of the four regions where they lie.
image::DisplayPicture with_axes(const image::DisplayPicture& slice, const std::string& title);

}  // namespace likeness::fit
