#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "render/baked/bake.h"

// The lobes that all texels of an asset share, in which a residual is written down as a function of the light's
// direction (spec: Realis, Bake, 4).
namespace likeness::realis {

using baked::Basis;
using baked::Lobe;

// Lobe by lobe towards each direction (unit): directions x lobes.
std::vector<double> values(std::span<const Lobe> lobes, std::span<const glm::dvec3> directions);

// The same of what a texel's coefficients are of: the lobes, or their mixes.
std::vector<double> values(const Basis& basis, std::span<const glm::dvec3> directions);

// `count` directions that stand for those given (unit): the farthest from those already chosen one after the other, then
// moved to the middle of what is nearest to them (k-means on the sphere) until nothing moves. No more than there are
// different ones; `count` of all of them are all of them, in their order. The same input gives the same output.
std::vector<glm::dvec3> spread_out(std::span<const glm::dvec3> directions, std::size_t count);

}  // namespace likeness::realis
