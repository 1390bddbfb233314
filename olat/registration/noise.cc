#include "olat/registration/noise.h"

#include <cmath>
#include <limits>
#include <vector>

#include "olat/registration/plane.h"

namespace likeness::registration {

Darkness darkness_of(const image::Picture& photo) {
  Darkness out;
  if (photo.width < 8 || photo.height < 8) return out;
  // A Gaussian of 2 pixels leaves 1 / (2 sqrt(pi) 2) of a pixel's noise.
  constexpr float kBlur = 2, kLeft = 0.141f;
  const Plane light = luminance(photo), smooth = blurred(light, kBlur);
  std::vector<float> all = smooth.values;
  const float fifth = quantile(all, 0.2);
  // Three sigmas on top: to take just the darkest of equals would be to choose by noise.
  const auto second = [](const auto& at, int x, int y) {
    return at(x - 1, y - 1) + at(x + 1, y - 1) + at(x - 1, y + 1) + at(x + 1, y + 1) -
           2 * (at(x, y - 1) + at(x, y + 1) + at(x - 1, y) + at(x + 1, y)) + 4 * at(x, y);
  };
  const auto noise_of = [&](const auto& at) {
    std::vector<float> magnitudes;
    for (int y = 1; y < photo.height - 1; ++y)
      for (int x = 1; x < photo.width - 1; ++x)
        if (const float d = smooth.at(x, y) <= fifth ? second(at, x, y) : std::numeric_limits<float>::quiet_NaN();
            std::isfinite(d))
          magnitudes.push_back(std::abs(d));
    return 1.4826f * quantile(magnitudes, 0.5) / 6;  // the squares of the filter's taps sum to 36
  };
  const float limit = fifth + 3 * kLeft * noise_of([&](int x, int y) { return light.at(x, y); });
  for (std::size_t c = 0; c < 3; ++c) {
    const auto at = [&](int x, int y) { return photo.at(x, y)[c]; };
    std::vector<float> levels, values;
    for (int y = 0; y < photo.height; ++y)
      for (int x = 0; x < photo.width; ++x) {
        if (!std::isfinite(at(x, y))) continue;
        values.push_back(at(x, y));
        if (smooth.at(x, y) <= limit) levels.push_back(at(x, y));
      }
    out.noise[c] = static_cast<double>(noise_of(at));
    out.level[c] = static_cast<double>(quantile(levels, 0.5));
    out.bright[c] = static_cast<double>(quantile(values, 0.99));
  }
  return out;
}

}  // namespace likeness::registration
