#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "realis/basis.h"
#include "realis/subject.h"

// Mixes of lobes: what the residuals of an asset have in common. A few coefficients of the mixes that explain most say more
// than as many of any lobes, polynomials or harmonics: no other functions of that number come nearer in the mean square.
namespace likeness::realis {

// Lobes at the lights, on four scales and one that is the same everywhere, and how free each scale is: a prior for
// residuals as functions of the direction (a Gaussian process). It knows where the lights are and nothing of the photographs:
// fits have seen those, and took out of the residuals what one light would have said of another, so that a search by
// lights that are left out finds that they say nothing. At most kMostLobes lobes; without lights the basis is empty.
// `length` is the distance of unit vectors within which residuals are alike.
inline constexpr double kPriorLength = 0.9;
Basis prior_of(std::span<const glm::dvec3> to_lights, double length = kPriorLength);

// Where lights are many, one of them is little of what fits have seen, and the length is the one that foretells each light
// of some texels best by the others (Gaussian process, in closed form). Below kLightsToChoose lights: kPriorLength.
inline constexpr std::size_t kLightsToChoose = 40;
double prior_length(const Subject& subject, double floor, std::uint64_t seed);

// Principal components of the residuals that the prior makes of the samples, as functions of the direction.
class Mixes {
 public:
  Mixes(const Subject& subject, const Basis& prior, double floor, std::uint64_t seed);
  ~Mixes();
  Mixes(Mixes&&) noexcept;

  std::size_t size() const;  // at most as many as lights
  // The first `count` of them, or all. Spreads are their deviations over that of what the prior calls noise.
  Basis first(std::size_t count) const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace likeness::realis
