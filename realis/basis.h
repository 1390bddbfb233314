#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

// The lobes that all texels of an asset share, in which a residual is written down as a function of the light's
// direction (spec: Realis, Bake, 4).
namespace likeness::realis {

// brdf::WindowedGaussian of amplitude 1.
struct Lobe {
  glm::dvec3 axis{0, 0, 1};  // unit, model space
  double sharpness = 1;      // >= 0
};

struct Basis {
  std::vector<Lobe> lobes;
  // What is known of a texel's coefficients before it was seen: their standard deviations about 0, in units of that of a
  // sample of weight 1. Ridge regression with 1 / spread^2: large ones are free, small ones are kept near 0.
  std::vector<double> spread;
};

// Lobe by lobe towards each direction (unit): directions x lobes.
std::vector<double> values(std::span<const Lobe> lobes, std::span<const glm::dvec3> directions);

// `count` directions that stand for those given (unit): the farthest from those already chosen one after the other, then
// moved to the middle of what is nearest to them (k-means on the sphere) until nothing moves. No more than there are
// different ones; `count` of all of them are all of them, in their order. The same input gives the same output.
std::vector<glm::dvec3> spread_out(std::span<const glm::dvec3> directions, std::size_t count);

}  // namespace likeness::realis
