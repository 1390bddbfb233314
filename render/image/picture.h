#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace likeness::image {

// A picture of linear light: RGB, float, row by row from the top left. The unit is the maker's to state.
struct Picture {
  int width = 0, height = 0;
  std::vector<float> rgb;  // 3 x width x height

  Picture() = default;
  Picture(int width_, int height_)
      : width(width_), height(height_), rgb(3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

  // The pixel in column x, row y; y = 0 is the top. 0 <= x < width, 0 <= y < height.
  std::span<float, 3> at(int x, int y) { return std::span<float, 3>(rgb.data() + index(x, y), 3); }
  std::span<const float, 3> at(int x, int y) const { return std::span<const float, 3>(rgb.data() + index(x, y), 3); }

 private:
  std::size_t index(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

// A picture as a display takes it: RGB, 8 bit, sRGB encoded, row by row from the top left. Another type than
// Picture, so that nobody computes light with it by mistake.
struct DisplayPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // 3 x width x height

  DisplayPicture() = default;
  DisplayPicture(int width_, int height_)
      : width(width_), height(height_), rgb(3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

  std::span<std::uint8_t, 3> at(int x, int y) { return std::span<std::uint8_t, 3>(rgb.data() + index(x, y), 3); }
  std::span<const std::uint8_t, 3> at(int x, int y) const {
    return std::span<const std::uint8_t, 3>(rgb.data() + index(x, y), 3);
  }

 private:
  std::size_t index(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

}  // namespace likeness::image
