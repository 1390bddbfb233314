#include "realis/weight/sensor.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

namespace likeness::realis::weight {
namespace {

constexpr double kLost = 1e-3;  // share of the lit samples that are exactly 0, from which on a sensor loses light

}  // namespace

Weights clipped(const Samples& s, const ClippedSettings& settings) {
  Weights out(s.samples(), 1.0f);
  tbb::parallel_for(std::size_t{0}, s.samples(), [&](std::size_t i) {
    for (const float x : s.photo[i])
      if (!std::isfinite(x) || static_cast<double>(x) >= settings.clip) out[i] = 0;
  });
  return out;
}

namespace {

// The least light that is seen of each channel, if what is less has become 0: of samples that the render lights the least
// values above 0, without the least thousandth of them. 0 of a channel in which nothing, or next to nothing, is exactly 0.
std::array<double, 3> least_seen(const Samples& s) {
  std::array<double, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> seen;
    std::size_t lost = 0;
    for (std::size_t i = 0; i < s.samples(); ++i) {
      if (!(s.render[i][c] > 0)) continue;
      if (s.photo[i][c] > 0) seen.push_back(static_cast<double>(s.photo[i][c]));
      lost += s.photo[i][c] == 0;
    }
    if (static_cast<double>(lost) > kLost * static_cast<double>(seen.size() + lost)) out[c] = quantile(seen, 0.001);
  }
  return out;
}

}  // namespace

Weights black(const Samples& s, const BlackSettings& settings) {
  Weights out(s.samples(), 1.0f);
  const std::size_t lights = s.lights();
  std::array<double, 3> least{settings.level, settings.level, settings.level};
  if (!(settings.level > 0)) least = least_seen(s);
  std::vector<std::uint8_t> is_dark(static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height), 2);
  tbb::parallel_for(std::size_t{0}, s.texels(), [&](std::size_t t) {
    bool is_dead = true, is_lit = false;
    for (std::size_t i = t * lights; i < (t + 1) * lights; ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto photo = static_cast<double>(s.photo[i][c]), render = static_cast<double>(s.render[i][c]);
        is_dead &= photo == 0, is_lit |= render > 0;
        // Where the render is far above what is seen at all, the photo is dark: a shadow.
        if (least[c] > 0 && render > 0 && photo >= 0 && photo < least[c] * (1 - 1e-6))
          out[i] = std::min(out[i], static_cast<float>(std::clamp(render / (1.5 * least[c]) - 1, 0.0, 1.0)));
      }
    is_dark[s.pixels[t]] = is_dead && is_lit ? 1 : 0;
  });
  // Dark under every light, among pixels that are not: dead.
  tbb::parallel_for(std::size_t{0}, s.texels(), [&](std::size_t t) {
    const int x = static_cast<int>(s.pixels[t]) % s.width, y = static_cast<int>(s.pixels[t]) / s.width;
    if (is_dark[s.pixels[t]] != 1) return;
    std::size_t dark = 0, all = 0;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, s.height - 1); ++v)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, s.width - 1); ++u) {
        const std::uint8_t other =
            is_dark[static_cast<std::size_t>(v) * static_cast<std::size_t>(s.width) + static_cast<std::size_t>(u)];
        all += other != 2, dark += other == 1;
      }
    if (all > 1 && 2 * dark <= all) std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(t * lights), lights, 0.0f);
  });
  return out;
}

}  // namespace likeness::realis::weight
