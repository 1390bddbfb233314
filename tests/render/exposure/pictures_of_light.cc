#include "tests/render/exposure/pictures_of_light.h"

#include <cmath>
#include <random>

namespace likeness::exposure::test {

image::Picture greys(const std::vector<float>& light) {
  image::Picture out(static_cast<int>(light.size()), 1);
  for (std::size_t i = 0; i < out.rgb.size(); ++i) out.rgb[i] = light[i / 3];
  return out;
}

image::Picture scattered(int width, int height, double stops, std::uint32_t seed) {
  image::Picture out(width, height);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < out.rgb.size(); i += 3) {
    const double light = 0.18 * std::exp2(stops * normal(random));
    for (std::size_t c = 0; c < 3; ++c) out.rgb[i + c] = static_cast<float>(light * std::exp2(0.5 * normal(random)));
  }
  return out;
}

image::Picture scaled(image::Picture picture, float scale) {
  for (float& v : picture.rgb) v *= scale;
  return picture;
}

}  // namespace likeness::exposure::test
