#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "realis/basis.h"
#include "realis/choose.h"
#include "realis/subject.h"

// The residual between photographs and renders, as a function of the light's direction: e(l) = sum_k c_k G_k(l) of each
// texel, with photo = render + e(l) max(cos_i, floor) for a light of irradiance 1 (spec: Realis).
namespace likeness::realis {

using baked::Channels;

struct BakeOptions {
  Channels channels = Channels::kLuminance;
  std::size_t lobes = 0;        // 0: as many as held-out lights ask for
  std::size_t most_lobes = 96;  // of that search
  std::size_t mixes = 0;        // coefficients of that many mixes (mixes.h) instead of lobes; 0: of lobes
  std::size_t dominant = 0;     // lobes that a texel keeps; 0: all
  bool is_exact = false;        // as many lobes as lights, free: photographs come back as they were
  // What a cosine counts for at least where E = photo - render is divided by it. Without it nothing could be said of
  // texels that the light grazes: they are lit by others, and normals are not exact.
  double floor = 0.4;
  baked::Bits bits = baked::Bits::kEight;  // of each stored coefficient
  std::uint64_t seed = 1;                  // of the texels that lobes are chosen by
  bool by_stops = true;  // lobes are chosen by stops of held-out lights too, or else by their light alone
};

// A bake, and how its lobes were chosen.
struct Bake : baked::Bake {
  std::vector<Choice> ladder;  // what was to choose from; empty if `lobes` was given
  std::size_t chosen = 0;      // in it
};

// Bakes; the same input gives the same bits for any number of threads. A texel whose weights are all 0 gets 0.
Bake bake(const Subject& subject, const BakeOptions& options, const GoesOn& goes_on);

// The same with lobes that were chosen before: what `options` says of choosing them is not looked at.
Bake bake_with(const Subject& subject, Basis basis, const BakeOptions& options, const GoesOn& goes_on);

// What a texel adds under a light (unit direction), for irradiance 1: three channels, luminance in all of them.
class Residual {
 public:
  Residual(const baked::Bake& bake, const glm::dvec3& to_light);
  std::array<double, 3> at(std::size_t texel, double cosine) const;

 private:
  const baked::Bake& bake_;
  std::vector<double> values_;
};

}  // namespace likeness::realis
