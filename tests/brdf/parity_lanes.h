#pragma once

#include <array>
#include <cstddef>

#include "brdf/batch.h"
#include "brdf/callisto.h"

// Callisto in batches of one instruction set. Compiled once for each, so only functions templated on that set may be
// called from here: any other would be compiled with instructions that the machine may lack.
namespace likeness::brdf::parity {

inline constexpr std::size_t kChannels = channel_count<Callisto<double>>();
inline constexpr std::size_t kCases = 16 * 256;

// Columns: kChannels parameters, then x y z of the light and of the view; f is the red channel. All of kCases.
template <class Arch>
void evaluate(const float* columns, float* f) {
  using S = xsimd::batch<float, Arch>;
  for (std::size_t i = 0; i < kCases; i += S::size) {
    S row[kChannels + 6];
    for (std::size_t k = 0; k < kChannels + 6; ++k) row[k] = S::load_unaligned(columns + k * kCases + i);
    const S* xyz = row + kChannels;
    const Geometry<S> g(Vec3<S>(xyz[0], xyz[1], xyz[2]), Vec3<S>(xyz[3], xyz[4], xyz[5]));
    model_from_channels<Callisto, S>(row).eval(g).r.store_unaligned(f + i);
  }
}

void with_sse2(const float* columns, float* f);
void with_avx2(const float* columns, float* f);
void with_avx512(const float* columns, float* f);

}  // namespace likeness::brdf::parity
