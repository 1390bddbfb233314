#include "realis/weight/sensor.h"

#include <cmath>

#include <tbb/parallel_for.h>

namespace likeness::realis::weight {

Weights clipped(const Samples& s, const ClippedSettings& settings) {
  Weights out(s.samples(), 1.0f);
  tbb::parallel_for(std::size_t{0}, s.samples(), [&](std::size_t i) {
    for (const float x : s.photo[i])
      if (!std::isfinite(x) || static_cast<double>(x) >= settings.clip) out[i] = 0;
  });
  return out;
}

Weights black(const Samples& s, const BlackSettings& settings) {
  Weights out(s.samples(), 1.0f);
  const std::size_t lights = s.lights();
  tbb::parallel_for(std::size_t{0}, lights, [&](std::size_t light) {
    std::vector<double> values;
    for (std::size_t t = 0; t < s.texels(); ++t)
      if (const double v = luminance(s.photo[t * lights + light]); std::isfinite(v)) values.push_back(v);
    const double level = settings.level * quantile(values, 0.99);
    for (std::size_t t = 0; t < s.texels(); ++t) {
      const std::size_t at = t * lights + light;
      if (luminance(s.photo[at]) <= level && luminance(s.render[at]) <= 4 * level) out[at] = 0;
    }
  });
  return out;
}

}  // namespace likeness::realis::weight
