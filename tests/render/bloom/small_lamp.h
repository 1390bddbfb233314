#pragma once

#include <cmath>
#include <cstdint>

#include "render/bloom/apply.h"

namespace likeness::bloom::test {

// A disc of radius 3 with a soft edge, a little beside the middle, and its photograph under a kernel with noise of 1 % and a
// floor, clipped at `clip`.
struct Lamp {
  image::Picture source, glare;
};

inline Lamp lamp(const Kernel& kernel, int side, double noise, float clip, double exposure = 1) {
  Lamp out{image::Picture(side, side), {}};
  const double cx = side / 2 + 0.3, cy = side / 2 - 0.2;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double inside = std::fmin(std::fmax(3.5 - std::hypot(x - cx, y - cy), 0), 1);
      for (std::size_t c = 0; c < 3; ++c)
        out.source.at(x, y)[c] = static_cast<float>(inside * (1000 - 200 * static_cast<double>(c)));
    }
  out.glare = apply(out.source, kernel).picture;
  std::uint64_t state = 99;
  const auto uniform = [&] {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(state >> 11) * 0x1p-53;
  };
  for (float& value : out.glare.rgb) {
    const double normal = std::sqrt(-2 * std::log(1 - uniform())) * std::cos(6.283185307179586 * uniform());
    const auto light = exposure * static_cast<double>(value);
    value = std::fmin(static_cast<float>(light + noise * normal * (0.01 + light)), clip);
  }
  return out;
}

}  // namespace likeness::bloom::test
