#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "brdf/realis/coefficient.h"
#include "brdf/realis/lobes.h"

// What a texel stores of its residual, and its evaluation.
namespace likeness::brdf {

// How many lobes of a texel are kept: the dominant ones.
inline constexpr std::size_t kRealisDominant = 8;

// The dominant lobes of a texel by their numbers, and their coefficients as bytes of coefficient.h, channel by channel.
// 16 bytes for luminance, 32 for RGB: one fetch of a texture of integers. Numbers and not a mask of all lobes: they take
// 8 bytes where a mask of 96 takes 12, and nothing has to be searched. A slot that is not used has the byte 128, which is
// 0; its number may be any. A new texel is 0.
template <std::size_t kChannels = 1>
struct RealisTexel {
  static_assert(kChannels == 1 || kChannels == 3);
  using Coefficients = std::array<std::uint8_t, kRealisDominant>;

  std::array<std::uint8_t, kRealisDominant> lobes{};
  std::array<Coefficients, kChannels> coefficients = zeros();

 private:
  static constexpr std::array<Coefficients, kChannels> zeros() {
    std::array<Coefficients, kChannels> all{};
    for (Coefficients& channel : all) channel.fill(kRealisZero);
    return all;
  }
};
static_assert(sizeof(RealisTexel<1>) == 16 && sizeof(RealisTexel<3>) == 32);

// One number for luminance, linear RGB for three channels.
template <Scalar S, std::size_t kChannels>
using RealisValue = std::conditional_t<kChannels == 1, S, Rgb<S>>;

namespace realis_texel {
template <Scalar S, std::size_t kChannels>
RealisValue<S, kChannels> value_of(const std::array<S, kChannels>& sums) {
  if constexpr (kChannels == 1) return sums[0];
  else return Rgb<S>(sums[0], sums[1], sums[2]);
}
}  // namespace realis_texel

// e(v) [1/sr] of a texel towards a unit vector in model space. Finite and continuous for every vector; the zero vector
// counts as 60 degrees from all axes. For many texels at once see brdf/realis/texels.h.
// Error   of windowed_decay(), against residual() of the same coefficients.
template <Scalar S, std::size_t kChannels>
RealisValue<S, kChannels> residual(const RealisLobes& lobes, const RealisTexel<kChannels>& texel,
                                   const Vec3<S>& direction) {
  std::array<S, kChannels> sums;
  sums.fill(S(0.0));
  for (std::size_t j = 0; j < kRealisDominant; ++j) {
    const std::size_t k = texel.lobes[j];
    const S g = lobes.eval(k, direction);
    for (std::size_t c = 0; c < kChannels; ++c)
      sums[c] =
          sums[c] + constant<S>(texel.coefficients[c][j] - kRealisZero) * (constant<S>(lobes.lobes[k].scale[c]) * g);
  }
  return realis_texel::value_of(sums);
}

// The same towards a direction that many texels share.
template <std::size_t kChannels>
RealisValue<float, kChannels> residual(const RealisTowards<kChannels>& towards, const RealisTexel<kChannels>& texel) {
  std::array<float, kChannels> sums{};
  for (std::size_t j = 0; j < kRealisDominant; ++j)
    for (std::size_t c = 0; c < kChannels; ++c)
      sums[c] += static_cast<float>(texel.coefficients[c][j] - kRealisZero) * towards.steps[c][texel.lobes[j]];
  return realis_texel::value_of(sums);
}

}  // namespace likeness::brdf
