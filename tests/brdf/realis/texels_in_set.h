#pragma once

#include <array>
#include <cstddef>

#include "brdf/realis/texel.h"

// residuals() of brdf/realis/texels.h as each instruction set has it.
namespace likeness::brdf {

template <std::size_t kChannels>
using Residuals = void (*)(const RealisLobes&, const RealisTexel<kChannels>*, const float* x, const float* y,
                           const float* z, const std::array<float*, kChannels>& out, std::size_t count);

template <std::size_t kChannels>
using ResidualsTowards = void (*)(const RealisTowards<kChannels>&, const RealisTexel<kChannels>*,
                                  const std::array<float*, kChannels>& out, std::size_t count);

struct TexelsInSet {
  Residuals<1> grey = nullptr;
  Residuals<3> rgb = nullptr;
  ResidualsTowards<1> grey_towards = nullptr;
  ResidualsTowards<3> rgb_towards = nullptr;
};

TexelsInSet texels_baseline();
TexelsInSet texels_avx2();    // may be called, not used, where the processor lacks the set
TexelsInSet texels_avx512();  // likewise

}  // namespace likeness::brdf
