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

// Residuals as functions of the direction have a prior, a Gaussian process (Rasmussen and Williams 2006): they are alike in
// directions that are near each other, within `length` of unit vectors. It knows where the lights are and nothing of the
// photographs: fits have seen those, and took out of the residuals what one light would have said of another, so that a
// search by lights that are left out finds that they say nothing.
//
// Where lights are many, one of them is little of what fits have seen, and the length is the one that foretells each light
// of some texels best by the others (in closed form). Below kLightsToChoose lights: kPriorLength.
inline constexpr double kPriorLength = 0.9;
inline constexpr std::size_t kLightsToChoose = 40;
double prior_length(const Subject& subject, double floor, std::uint64_t seed);

// Principal components of the residuals that the prior makes of the samples, as functions of the direction: sums of lobes at
// the lights, on four scales and one that is the same everywhere (at most kMostLobes), which are the prior's to 1 % of a
// residual between and near the lights. Without lights there is no lobe.
class Mixes {
 public:
  Mixes(const Subject& subject, double length, double floor, std::uint64_t seed);
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
