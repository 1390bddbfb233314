#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fit/measured/half_angles.h"
#include "fit/measured/measured.h"

namespace likeness::measured {

// A sample at theta_i, theta_o in 0..pi/2 and phi in 0..pi, radians.
struct Scattered {
  float theta_i, theta_o, phi;
  float r, g, b;
  float weight;
};

// Isotropic samples at any places, found by nearness.
class ScatteredSamples {
 public:
  ScatteredSamples() = default;
  // Samples must be sorted by by_angles, without two of the same angles.
  explicit ScatteredSamples(std::vector<Scattered> samples, double reach);

  const std::vector<Scattered>& samples() const { return samples_; }

  // The interpolant of csv.h at angles in radians; false, and f untouched, if no sample is in reach.
  bool interpolate(const Elevations& at, Rgb& f) const;

  static bool by_angles(const Scattered& a, const Scattered& b);

 private:
  static constexpr int kMost = 7;  // the last one sets the radius
  struct Near {
    double distance2;
    const Scattered* sample;
  };

  std::vector<Scattered> samples_;  // by cell of (theta_i, theta_o), then by phi
  std::vector<std::uint32_t> first_;  // of each cell; one more than cells
  double reach_ = 0;
  int cells_ = 0;  // a side
};

}  // namespace likeness::measured
