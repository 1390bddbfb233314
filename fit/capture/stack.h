#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "render/capture/pixels.h"

// The photographs of a camera turned into pixels: all that a pixel was seen as, light by light, side by side.
namespace likeness::capture_fit {

struct Stack {
  std::vector<std::size_t> lights;    // positions in Capture::lights, ascending
  std::vector<std::uint32_t> pixels;  // y * width + x, ascending
  // [pixel][channel][light], the photo's light; NaN where it is not to be trusted: clipped, or not finite in the file.
  std::vector<float> light;
  std::size_t clipped = 0, not_finite = 0, negative = 0;  // samples; negative: the mean of the channels is

  // The channel c of pixel i, in the order of `lights`.
  std::span<const float> of(std::size_t i, std::size_t c) const {
    return {light.data() + (3 * i + c) * lights.size(), lights.size()};
  }
};

// Reads a photo of each light, several at a time. `goes_on` is asked in between, from the calling thread, with the number of
// photos that are read; where it says no, files::Interrupted is thrown. Throws files::InputError.
Stack read_stack(const capture::Capture& capture, std::size_t camera, const capture::CameraLayers& layers,
                 std::vector<std::size_t> lights, std::vector<std::uint32_t> pixels,
                 const std::function<bool(std::size_t photos)>& goes_on);

// Some of the pixels of a stack; `which` are positions in its pixels, ascending.
Stack part_of(const Stack& stack, const std::vector<std::size_t>& which);

}  // namespace likeness::capture_fit
