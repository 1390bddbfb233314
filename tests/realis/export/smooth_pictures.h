#pragma once

#include <cmath>
#include <cstddef>

#include <glm/vec3.hpp>

#include "realis/export/planes.h"

namespace likeness::realis::test {

// Pictures that a format represents: each color is a sum of a few waves over the picture times the format's own terms, so
// that the least squares find what was put in. Values keep away from 0 and 1, where they would be clipped.
inline double wave(std::size_t term, std::size_t c, int x, int y) {
  const auto t = static_cast<double>(term), k = static_cast<double>(c);
  return 0.08 / (1 + t) * std::sin(0.11 * x * (1 + 0.1 * t) + 0.07 * y * (1 + k) + t);
}
inline Lit smooth_pictures(Format format, std::size_t lights, int width = 40, int height = 24) {
  Lit out{width, height, on_disc(lights), {}};
  out.picture = [=, to_lights = out.to_lights](std::size_t light) {
    // Components are shared by all colors, so there a few are waves and the rest none.
    const bool has_components = row_of(format).has_components;
    const std::vector<double> terms = terms_of(format, to_lights[light]);
    image::Picture picture(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (std::size_t c = 0; c < 3; ++c) {
          double sum = 0.5;
          for (std::size_t t = 0; t < (has_components ? std::size_t{6} : terms.size()); ++t)
            sum += terms[t] * wave(t, c, x, y);
          picture.at(x, y)[c] = static_cast<float>(sum);
        }
    return picture;
  };
  return out;
}

inline bool goes_on(double, std::string_view) { return true; }

}  // namespace likeness::realis::test
