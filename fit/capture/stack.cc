#include "fit/capture/stack.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>

#include "render/files/interrupt.h"

namespace likeness::capture_fit {
namespace {

constexpr std::size_t kAtATime = 8;  // photos between two questions
constexpr float kUnusable = std::numeric_limits<float>::quiet_NaN();

}  // namespace

Stack read_stack(const capture::Capture& capture, std::size_t camera, const capture::CameraLayers& layers,
                 std::vector<std::size_t> lights, std::vector<std::uint32_t> pixels,
                 const std::function<bool(std::size_t photos)>& goes_on) {
  Stack out;
  out.lights = std::move(lights);
  out.pixels = std::move(pixels);
  const std::size_t count = out.lights.size();
  out.light.resize(3 * out.pixels.size() * count);
  const capture::FrameTable frames(capture);
  std::atomic<std::size_t> clipped = 0, not_finite = 0, negative = 0;
  for (std::size_t first = 0; first < count; first += kAtATime) {
    if (!goes_on(first)) throw files::Interrupted();
    tbb::parallel_for(first, std::min(first + kAtATime, count), [&](std::size_t at) {
      const capture::Photo photo = capture::read_photo(capture, frames.frame(camera, out.lights[at]), layers);
      std::size_t full = 0, broken = 0, below = 0;
      for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        const std::uint8_t flaws = photo.flaws[out.pixels[i]];
        const float* rgb = photo.light.rgb.data() + 3 * static_cast<std::size_t>(out.pixels[i]);
        const bool is_broken = (flaws & capture::kNotFinite) != 0, is_full = (flaws & capture::kClipped) != 0;
        broken += is_broken ? 1 : 0;
        full += is_full && !is_broken ? 1 : 0;
        below += !is_broken && rgb[0] + rgb[1] + rgb[2] < 0 ? 1 : 0;
        for (std::size_t c = 0; c < 3; ++c)
          out.light[(3 * i + c) * count + at] = is_broken || is_full ? kUnusable : rgb[c];
      }
      clipped += full;
      not_finite += broken;
      negative += below;
    });
  }
  out.clipped = clipped;
  out.not_finite = not_finite;
  out.negative = negative;
  return out;
}

Stack part_of(const Stack& stack, const std::vector<std::size_t>& which) {
  Stack out;
  out.lights = stack.lights;
  for (const std::size_t i : which) {
    out.pixels.push_back(stack.pixels[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto values = stack.of(i, c);
      out.light.insert(out.light.end(), values.begin(), values.end());
    }
  }
  return out;
}

}  // namespace likeness::capture_fit
