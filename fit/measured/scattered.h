#pragma once

#include <array>
#include <vector>

#include "fit/measured/half_angles.h"
#include "fit/measured/measured.h"

namespace likeness::measured {

// A sample at theta_i, theta_o in 0..pi/2 and phi in 0..pi, radians.
struct Scattered {
  std::array<float, 3> angles;  // theta_i, theta_o, phi
  float r, g, b;
  float weight;
};

// Isotropic samples at any places, found by nearness: a k-d tree over the three angles.
class ScatteredSamples {
 public:
  ScatteredSamples() = default;
  // No two samples may have the same angles. Puts them into the tree's order, which depends on nothing but them.
  ScatteredSamples(std::vector<Scattered> samples, double reach);

  const std::vector<Scattered>& samples() const { return samples_; }

  // The interpolant of csv.h; false, and f untouched, if no sample is in reach.
  bool interpolate(const Elevations& at, Rgb& f) const;

 private:
  static constexpr std::size_t kLeaf = 8;
  struct Box {
    std::array<float, 3> low{0, 0, 0}, high{1.6f, 1.6f, 3.2f};
  };
  struct Search;

  void build(std::size_t begin, std::size_t end, const Box& box);
  void visit(std::size_t begin, std::size_t end, const Box& box, Search& search) const;
  static int widest(const Box& box);

  // A node is a range: its middle sample splits it along the widest side of its box.
  std::vector<Scattered> samples_;
  double reach_ = 0;
};

}  // namespace likeness::measured
