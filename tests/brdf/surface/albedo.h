#pragma once

#include "tests/brdf/evaluate.h"

namespace likeness::brdf {

// The integral of f cos over the light's hemisphere for a view at height z, of a model that is even in the azimuth.
// Midpoint rule, both variables graded towards the horizon and the two azimuths in the plane of the view; about 1e-5.
template <class M>
double albedo(const M& model, double z, int steps = 200) {
  const Vec3<double> v = Random::direction_at(z, 0);
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double s = (i + 0.5) / steps, t = (j + 0.5) / steps;
      const double mu = s * s, phi = std::numbers::pi * t * t * (3 - 2 * t);
      const Vec3<double> l = Random::direction_at(mu, phi);
      sum += first(model.eval(l, v).g) * mu * 2 * s * 6 * t * (1 - t);
    }
  return 2 * std::numbers::pi * sum / (double(steps) * steps);
}

}  // namespace likeness::brdf
