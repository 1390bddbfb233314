#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "brdf/batch.h"
#include "brdf/realis/texel.h"

// The residuals of many texels, each towards its own direction, in batches.
namespace likeness::brdf {

namespace realis_texels {

// How a batch is filled and emptied. A batch holds lobes of one texel, which lie side by side in its bytes. This is for
// any width; processors with AVX2 have their own below. Everything is a template on the batch (brdf/batch.h).
template <class B>
struct Lanes {
  static_assert(kRealisDominant % B::size == 0, "eight lobes do not fill batches of this width: take a narrower one");

  // Rows of RealisLobes as columns, those of the lobes that B::size bytes name.
  struct Columns {
    B x, y, z, reach, scale[3];
  };
  static Columns columns(const RealisLobes::Lobe* lobes, const std::uint8_t* numbers) {
    const auto column = [&](float RealisLobes::Lobe::* part) {
      return of_each([&](std::size_t j) { return lobes[numbers[j]].*part; });
    };
    using Lobe = RealisLobes::Lobe;
    const auto scale = [&](std::size_t channel) {
      return of_each([&](std::size_t j) { return lobes[numbers[j]].scale[channel]; });
    };
    return {column(&Lobe::x), column(&Lobe::y), column(&Lobe::z), column(&Lobe::reach), {scale(0), scale(1), scale(2)}};
  }
  static B numbers(const std::uint8_t* bytes) {
    return of_each([&](std::size_t j) { return float(bytes[j]); });
  }
  // The entries of a table that B::size bytes name.
  static B entries(const float* table, const std::uint8_t* numbers) {
    return of_each([&](std::size_t j) { return table[numbers[j]]; });
  }
  // The sums of `count` rows of eight, pairs first.
  static void sums(const float* rows, float* out, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i, rows += kRealisDominant)
      out[i] = ((rows[0] + rows[1]) + (rows[2] + rows[3])) + ((rows[4] + rows[5]) + (rows[6] + rows[7]));
  }

 private:
  template <class F>
  static B of_each(const F& entry) {
#ifdef __SSE2__
    if constexpr (B::size == 4) return _mm_setr_ps(entry(0), entry(1), entry(2), entry(3));
#endif
    alignas(64) float lanes[B::size];
    for (std::size_t j = 0; j < B::size; ++j) lanes[j] = entry(j);
    return B::load_aligned(lanes);
  }
};

#ifdef __AVX2__
// Loads and shuffles. Gathering instructions, which are made of many loads, were slower.
template <class A>
struct Lanes<xsimd::batch<float, A>> {
  using B = xsimd::batch<float, A>;
  static_assert(B::size == kRealisDominant, "eight lobes do not fill a batch of this width: take eight lanes");

  struct Columns {
    B x, y, z, reach, scale[3];
  };
  static Columns columns(const RealisLobes::Lobe* lobes, const std::uint8_t* numbers) {
    const auto two = [&](int j, int part) {  // lobe j in the lower half, j + 4 in the upper one
      const float* low = reinterpret_cast<const float*>(lobes + numbers[j]) + part;
      const float* high = reinterpret_cast<const float*>(lobes + numbers[j + 4]) + part;
      return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(low)), _mm_load_ps(high), 1);
    };
    const __m256 a = two(0, 0), b = two(1, 0), c = two(2, 0), d = two(3, 0);
    const __m256 xy = _mm256_unpacklo_ps(a, b), xy_next = _mm256_unpacklo_ps(c, d);
    const __m256 zr = _mm256_unpackhi_ps(a, b), zr_next = _mm256_unpackhi_ps(c, d);
    const __m256 e = two(0, 4), f = two(1, 4), g = two(2, 4), h = two(3, 4);  // what is not used is not made
    const __m256 scale = _mm256_unpacklo_ps(e, f), scale_next = _mm256_unpacklo_ps(g, h);
    return {_mm256_shuffle_ps(xy, xy_next, 0x44),
            _mm256_shuffle_ps(xy, xy_next, 0xee),
            _mm256_shuffle_ps(zr, zr_next, 0x44),
            _mm256_shuffle_ps(zr, zr_next, 0xee),
            {_mm256_shuffle_ps(scale, scale_next, 0x44), _mm256_shuffle_ps(scale, scale_next, 0xee),
             _mm256_shuffle_ps(_mm256_unpackhi_ps(e, f), _mm256_unpackhi_ps(g, h), 0x44)}};
  }
  static B numbers(const std::uint8_t* bytes) {
    return _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes))));
  }
  static B entries(const float* t, const std::uint8_t* n) {
    return _mm256_set_ps(t[n[7]], t[n[6]], t[n[5]], t[n[4]], t[n[3]], t[n[2]], t[n[1]], t[n[0]]);
  }
  static void sums(const float* rows, float* out, std::size_t count) {
    const auto row = [&](std::size_t k) { return _mm256_load_ps(rows + k * kRealisDominant); };
    const auto pairs = [](__m256 a, __m256 b) {
      return _mm256_add_ps(_mm256_shuffle_ps(a, b, 0x88), _mm256_shuffle_ps(a, b, 0xdd));
    };
    std::size_t i = 0;
    for (; i + 8 <= count; i += 8) {
      const __m256 low = pairs(pairs(row(i), row(i + 1)), pairs(row(i + 2), row(i + 3)));
      const __m256 high = pairs(pairs(row(i + 4), row(i + 5)), pairs(row(i + 6), row(i + 7)));
      _mm256_storeu_ps(out + i,
                       _mm256_add_ps(_mm256_permute2f128_ps(low, high, 0x20), _mm256_permute2f128_ps(low, high, 0x31)));
    }
    for (; i < count; ++i) {
      const float* r = rows + i * kRealisDominant;
      out[i] = ((r[0] + r[1]) + (r[2] + r[3])) + ((r[4] + r[5]) + (r[6] + r[7]));
    }
  }
};
#endif

// Batches of the widest kind that eight lobes fill, in the set that the including file is compiled for.
#ifdef __AVX2__
using Widest = xsimd::make_sized_batch_t<float, 8>;
#else
using Widest = xsimd::make_sized_batch_t<float, 4>;
#endif

}  // namespace realis_texels

// residual() of texel i towards (x[i], y[i], z[i]), written to out[channel][i], for i < count: unit vectors in model space.
// No alignment is needed, and nothing is read or written past `count`.
// Error   against residual() in float, 4 ulp of the sum of the coefficients' magnitudes; so much may lie between
//         instruction sets too, of which only some round a multiply-add once. Not of the residual itself: its terms have
//         both signs, and a lobe's own digits end where it does.
template <class B = realis_texels::Widest, std::size_t kChannels>
void residuals(const RealisLobes& lobes, const RealisTexel<kChannels>* texels, const float* x, const float* y,
               const float* z, const std::array<float*, kChannels>& out, std::size_t count) {
  using Lanes = realis_texels::Lanes<B>;
  // Three loops over a block and not one over texels: in one chain of a hundred dependent cycles the processor sees two
  // texels ahead, in three short ones it is busy all the time (13.6 ns against 9.1).
  constexpr std::size_t kBlock = 16, kEntries = kBlock * kRealisDominant;
  alignas(64) float t[kEntries], parts[kChannels][kEntries];
  for (std::size_t first = 0; first < count; first += kBlock) {
    const std::size_t block = count - first < kBlock ? count - first : kBlock;
    for (std::size_t i = 0; i < block; ++i) {
      const RealisTexel<kChannels>& texel = texels[first + i];
      const Vec3<B> v{B(x[first + i]), B(y[first + i]), B(z[first + i])};
      for (std::size_t j = 0; j < kRealisDominant; j += B::size) {
        const std::size_t entry = i * kRealisDominant + j;
        const auto lobe = Lanes::columns(lobes.lobes.data(), texel.lobes.data() + j);
        const Vec3<B> d = Vec3<B>(lobe.x, lobe.y, lobe.z) - v;
        const B square = multiply_add(d.z, d.z, multiply_add(d.y, d.y, B(d.x * d.x)));
        xsimd::min(B(1.f), B(lobe.reach * square)).store_aligned(t + entry);
        for (std::size_t channel = 0; channel < kChannels; ++channel) {
          const B byte = Lanes::numbers(texel.coefficients[channel].data() + j);
          ((byte - B(float(kRealisZero))) * lobe.scale[channel]).store_aligned(parts[channel] + entry);
        }
      }
    }
    for (std::size_t entry = 0; entry < block * kRealisDominant; entry += B::size) {
      const B g = windowed_decay_within(B::load_aligned(t + entry));
      for (std::size_t channel = 0; channel < kChannels; ++channel)
        (B::load_aligned(parts[channel] + entry) * g).store_aligned(parts[channel] + entry);
    }
    for (std::size_t channel = 0; channel < kChannels; ++channel)
      Lanes::sums(parts[channel], out[channel] + first, block);
  }
}

// The same towards a direction that all texels share.
template <class B = realis_texels::Widest, std::size_t kChannels>
void residuals(const RealisTowards<kChannels>& towards, const RealisTexel<kChannels>* texels,
               const std::array<float*, kChannels>& out, std::size_t count) {
  using Lanes = realis_texels::Lanes<B>;
  constexpr std::size_t kBlock = 16;
  alignas(64) float parts[kChannels][kBlock * kRealisDominant];
  for (std::size_t first = 0; first < count; first += kBlock) {
    const std::size_t block = count - first < kBlock ? count - first : kBlock;
    for (std::size_t i = 0; i < block; ++i)
      for (std::size_t j = 0; j < kRealisDominant; j += B::size) {
        for (std::size_t channel = 0; channel < kChannels; ++channel) {
          const B byte = Lanes::numbers(texels[first + i].coefficients[channel].data() + j);
          const B step = Lanes::entries(towards.steps[channel].data(), texels[first + i].lobes.data() + j);
          ((byte - B(float(kRealisZero))) * step).store_aligned(parts[channel] + i * kRealisDominant + j);
        }
      }
    for (std::size_t channel = 0; channel < kChannels; ++channel)
      Lanes::sums(parts[channel], out[channel] + first, block);
  }
}

}  // namespace likeness::brdf
