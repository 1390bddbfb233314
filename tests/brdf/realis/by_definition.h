#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "brdf/realis.h"
#include "tests/brdf/evaluate.h"

// The residual as the specification words it, in double and by other formulas than brdf/ has.
namespace likeness::brdf {

struct WrittenLobe {
  Vec3<double> axis;
  double sharpness = 0, coefficient = 0;
};

// exp(lambda (mu . v - 1)) times a smoothstep of mu . v, from where the Gaussian falls to 1 % up to the axis.
inline double lobe_by_definition(double cosine, double sharpness) {
  const double gaussian = std::exp(sharpness * (cosine - 1));
  if (sharpness == 0) return gaussian;
  const double end = 1 - std::log(100) / sharpness;
  const double t = std::clamp((cosine - end) / (1 - end), 0.0, 1.0);
  return gaussian * (3 - 2 * t) * t * t;
}

inline double residual_by_definition(const std::vector<WrittenLobe>& lobes, const Vec3<double>& v) {
  double sum = 0;
  for (const WrittenLobe& lobe : lobes) sum += lobe.coefficient * lobe_by_definition(dot(lobe.axis, v), lobe.sharpness);
  return sum;
}

inline double magnitude(const std::vector<WrittenLobe>& lobes) {
  double sum = 0;
  for (const WrittenLobe& lobe : lobes) sum += std::abs(lobe.coefficient);
  return sum;
}

// Lobes for all bytes of a texel, and a texel that names eight of them; `coefficient` is what the texel's bytes mean.
struct Drawn {
  RealisLobes lobes;
  RealisTexel<1> texel;
  std::vector<WrittenLobe> written;
};
inline Drawn drawn_texel(Random& random, double largest_sharpness = 40, std::size_t count = 96) {
  Drawn out;
  std::vector<WrittenLobe> all(count);
  std::vector<double> multipliers(count);
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3<float> axis(random.direction(-1));
    const float sharpness = float(std::exp(random.uniform(-3, std::log(largest_sharpness))));
    const float multiplier = float(random.uniform(0.01, 1));
    out.lobes.place(k, axis, sharpness, multiplier);
    all[k] = {Vec3<double>(axis), sharpness, 0};
    multipliers[k] = multiplier;
  }
  for (std::size_t j = 0; j < kRealisDominant; ++j) {
    const std::size_t k = random.index(count);
    const std::uint8_t byte = std::uint8_t(1 + random.index(255));
    out.texel.lobes[j] = std::uint8_t(k);
    out.texel.coefficients[0][j] = byte;
    out.written.push_back({all[k].axis, all[k].sharpness, multipliers[k] * (byte - 128.0) / 127});
  }
  return out;
}

}  // namespace likeness::brdf
