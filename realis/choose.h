#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "realis/basis.h"

// Which lobes: found from the data, by what they say of lights that they have not seen.
namespace likeness::realis {

// Residuals of some texels that stand for the rest, in the unit of light (not divided by cosines), so that every sample
// counts alike: texel by texel, in each the lights.
struct Sampled {
  std::vector<glm::dvec3> to_lights;  // unit
  std::vector<float> residuals;
  // What was photographed, like residuals: then errors count in stops, too. Empty: only as light.
  std::vector<float> photos{};
  // How far each residual is trusted, [0, 1], like residuals; empty: 1. One that is trusted less counts less, and its place
  // is taken by what the texel's lights around it say: it may not decide what lobes have to explain.
  std::vector<float> weights{};
  std::size_t texels() const { return to_lights.empty() ? 0 : residuals.size() / to_lights.size(); }
};

struct Choice {
  Basis basis;
  double held_out = 0;  // root mean square of what is left of a residual when its light is left out [of the residuals]
  double plain = 0;     // of the residuals themselves
};

// `count` lobes on up to four scales: axes by spread_out(), at most as many as lights on each, a fourth of them on
// each wider one; sharpness such that a lobe has fallen to a half at its neighbour, times a factor; on each scale one
// spread. Factor and spreads minimise held_out, times the root mean square of held-out stops if there are photos, by a
// compass search in their logarithms; of what these cannot tell apart they take the less free. Finite for whatever is
// given: of zero lights, texels or lobes the basis is empty.
Choice choose_basis(const Sampled& sampled, std::size_t count);

// As many lobes as different lights, at their directions, and free: the photographs come back as they were.
Basis exact_basis(std::span<const glm::dvec3> to_lights);

// Choices of more and more lobes, up to `most`, until more do not help: the last ones that do come last. What it costs
// to know less is what a user looks at (spec: K chosen by held-out error against bytes).
std::vector<Choice> ladder(const Sampled& sampled, std::size_t most, const std::function<void(double)>& tell);
// The first of a ladder whose held_out is within `tolerance` of the best.
std::size_t chosen_of(std::span<const Choice> ladder, double tolerance = 0.02);

}  // namespace likeness::realis
