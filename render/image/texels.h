#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace likeness::image {

// The pixels of a file as it stores them: 8 bits, or floats of everything deeper. Row by row from the top left,
// channels interleaved; 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA. One of the two vectors is empty.
struct Texels {
  int width = 0, height = 0, channels = 0;
  std::vector<std::uint8_t> bytes;
  std::vector<float> floats;

  bool is_empty() const { return width == 0; }
  std::size_t count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

}  // namespace likeness::image
