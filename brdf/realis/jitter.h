#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>

#include "brdf/realis/texel.h"

// A texel's residual from a few of its lobes at a time, for renderers that average over frames.
namespace likeness::brdf {

// Which slots of a texel are drawn: slot j with the probability |c_j| / sum_i |c_i| at each of `count` draws, which a
// single random number `u` in [0, 1) spreads evenly over the slots (systematic sampling). Calls
// draw(slot, share) for each, where the sum of share c_slot G_slot has the expectation sum_j c_j G_j over u. The share
// is sum_i |c_i| / (count |c_slot|) [1]. No calls if all coefficients are 0 or count is 0.
// Of three channels, c_j is the largest one's.
// Variance  that of G between lobes and of the coefficients' signs, not of their sizes.
template <std::size_t kChannels, class F>
void for_each_drawn(const RealisLobes& lobes, const RealisTexel<kChannels>& texel, float u, std::size_t count,
                    F&& draw) {
  std::array<float, kRealisDominant> ends;  // of the slots' intervals, one after the other
  float total = 0;
  std::size_t last = 0;
  for (std::size_t j = 0; j < kRealisDominant; ++j) {
    float largest = 0;
    for (std::size_t c = 0; c < kChannels; ++c)
      largest = std::max(largest, lobes.lobes[texel.lobes[j]].scale[c] *
                                      static_cast<float>(std::abs(texel.coefficients[c][j] - kRealisZero)));
    const float before = total;
    ends[j] = total += largest;
    if (total > before) last = j;
  }
  if (!(total > 0)) return;
  const float step = total / static_cast<float>(count);
  for (std::size_t i = 0, j = 0; i < count; ++i) {
    const float at = (static_cast<float>(i) + u) * step;
    while (j < last && !(at < ends[j])) ++j;
    draw(j, step / (ends[j] - (j > 0 ? ends[j - 1] : 0)));
  }
}

// An estimate of residual(lobes, texel, direction) from `count` lobes, whose mean over u in [0, 1) is that value.
template <Scalar S, std::size_t kChannels>
RealisValue<S, kChannels> jittered_residual(const RealisLobes& lobes, const RealisTexel<kChannels>& texel,
                                            const Vec3<S>& direction, float u, std::size_t count) {
  std::array<S, kChannels> sums;
  sums.fill(S(0.0));
  for_each_drawn(lobes, texel, u, count, [&](std::size_t j, float share) {
    const std::size_t k = texel.lobes[j];
    const S g = lobes.eval(k, direction);
    for (std::size_t c = 0; c < kChannels; ++c)
      sums[c] = sums[c] + constant<S>(texel.coefficients[c][j] - kRealisZero) *
                              (constant<S>(share * lobes.lobes[k].scale[c]) * g);
  });
  return realis_texel::value_of(sums);
}

}  // namespace likeness::brdf
