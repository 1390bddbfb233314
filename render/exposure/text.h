#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "render/image/picture.h"

// Short labels in pictures: letters of 5 x 7 dots, drawn by hand, capitals, digits and a few signs. A label is dots of one
// color and nothing else, so what is around it stays as it is.
namespace likeness::exposure {

inline constexpr int kLetterWidth = 5, kLetterHeight = 7, kLetterStep = 6;  // [dot]

// Of a text, [dot]; without the gap after its last letter.
constexpr int text_width(std::string_view text) {
  return text.empty() ? 0 : static_cast<int>(text.size()) * kLetterStep - 1;
}

// The rows of a letter from its top, five bits each, the left one highest. Small letters are shown as capitals; what there is no
// letter for is a box.
std::uint64_t letter(char c);

// Dots of `scale` x `scale` pixels, the first at (x, y). What is outside of the picture is left out.
void draw_text(image::DisplayPicture& picture, int x, int y, std::string_view text, int scale, std::uint8_t grey);

// The Roman numeral of a zone, 0 to 16: 0, I, ... XVI.
std::string_view zone_numeral(int zone);

// The zone that a text names: a numeral, or a number from 0 to 16 that need not be whole; less than 0 if none.
double zone_named(std::string_view text);

}  // namespace likeness::exposure
