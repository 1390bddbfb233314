#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <ImfPixelType.h>

namespace likeness::image::test {

// What a test writes into an EXR: channel c has the value `value(c, x, y)` at each pixel of the data window.
struct ExrPart {
  std::vector<std::string> channels{"R", "G", "B"};
  Imf::PixelType type = Imf::FLOAT;
  int width = 5, height = 3;                     // of the display window, whose top left is (0, 0)
  int left = 0, top = 0, right = 4, bottom = 2;  // of the data window, inclusive
  int tile = 0;                                  // 0: scan lines
  std::string name;                              // of the part
};

float exr_value(std::size_t channel, int x, int y);

// One part, or a multipart file.
std::string exr_bytes(const std::vector<ExrPart>& parts);

// The file with the windows of its header, of which there is one each, replaced: "displayWindow" or "dataWindow".
std::string with_window(std::string bytes, std::string_view attribute, int left, int top, int right, int bottom);

}  // namespace likeness::image::test
