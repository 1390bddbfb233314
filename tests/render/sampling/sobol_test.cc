#include <array>
#include <bitset>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "render/sampling/sobol.h"
#include "tests/brdf/chi_square.h"

namespace likeness::sampling {
namespace {

using brdf::chi_square;
using brdf::sidak;

// The points `first` to `first + count` of pair `pair` of a pixel.
std::vector<glm::vec2> points(std::uint32_t pixel, std::uint32_t seed, int pair, std::uint32_t first,
                              std::uint32_t count) {
  std::vector<glm::vec2> out;
  for (std::uint32_t i = 0; i < count; ++i) {
    Samples samples(pixel, first + i, seed);
    glm::vec2 p{};
    for (int k = 0; k <= pair; ++k) p = samples.next();
    out.push_back(p);
  }
  return out;
}

TEST(SobolSecond, IsTheColumnsOfPascalsTriangle) {
  // Direction numbers of the second dimension by its recurrence (Joe and Kuo 2008): v1 = 2^31, v_k = v_(k-1) ^ v_(k-1) / 2.
  std::array<std::uint32_t, 32> v{};
  v[0] = 0x80000000u;
  for (std::size_t k = 1; k < v.size(); ++k) v[k] = v[k - 1] ^ (v[k - 1] >> 1);
  std::uint32_t x = 1;
  for (int i = 0; i < 20000; ++i) {
    const std::uint32_t index = i < 4096 ? static_cast<std::uint32_t>(i) : (x = x * 1664525u + 1013904223u);
    std::uint32_t expected = 0;
    for (std::size_t k = 0; k < 32; ++k)
      if ((index >> k) & 1u) expected ^= v[k];
    ASSERT_EQ(reversed_bits(sobol_second_reversed(index)), expected) << index;
  }
}

TEST(ReversedBits, TurnsEveryBit) {
  for (unsigned i = 0; i < 32; ++i) EXPECT_EQ(reversed_bits(1u << i), 1u << (31 - i));
  EXPECT_EQ(reversed_bits(0x12345678u), 0x1e6a2c48u);
}

TEST(Owen, FlipsEachBitByThoseBelowItAlone) {
  std::uint32_t x = 12345;
  for (const std::uint32_t seed : {0u, 1u, 0x80000000u, 0xffffffffu, 0x12345678u})
    for (int i = 0; i < 2000; ++i) {
      x = mixed(x);
      const unsigned bit = x % 32;
      const std::uint32_t difference = owen_of_reversed(x, seed) ^ owen_of_reversed(x ^ (1u << bit), seed);
      // The changed bit changes, whatever the rest; nothing below it does.
      ASSERT_EQ(difference & ((2u << bit) - 1u), 1u << bit) << seed << " " << x << " " << bit;
    }
}

TEST(Samples, AreStratifiedInEveryElementaryRectangle) {
  int checked = 0;
  for (const std::uint32_t seed : {0u, 1u, 77u, 0xffffffffu})
    for (const std::uint32_t pixel : {0u, 1u, 123456u})
      for (const int pair : {0, 1, 2, 9, 40})
        for (unsigned log = 0; log <= 10; ++log) {
          const std::uint32_t count = 1u << log;
          // Any aligned block of them, not the first alone.
          for (const std::uint32_t block : {0u, 1u, 37u}) {
            const auto p = points(pixel, seed, pair, block * count, count);
            for (unsigned in_x = 0; in_x <= log; ++in_x) {
              std::vector<int> hits(count, 0);
              for (const glm::vec2& q : p) {
                const auto column = static_cast<std::size_t>(std::ldexp(q.x, static_cast<int>(in_x)));
                const auto row = static_cast<std::size_t>(std::ldexp(q.y, static_cast<int>(log - in_x)));
                ++hits[(row << in_x) + column];
              }
              ++checked;
              for (std::size_t k = 0; k < count; ++k) ASSERT_EQ(hits[k], 1) << seed << " " << pixel << " " << pair;
            }
          }
        }
  EXPECT_EQ(checked, 4 * 3 * 5 * 3 * 66);
}

TEST(Samples, AreNeverOneAndNeverNegative) {
  EXPECT_EQ(unit(0xffffffffu), 0x1.fffffep-1f);
  EXPECT_EQ(unit(0u), 0.0f);
}

// Whether numbers a and b in [0, 1) come in pairs as if they were independent: a grid of 16 x 16 cells.
double p_of_independence(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<double> counts(256, 0), expected(256, static_cast<double>(a.size()) / 256);
  for (std::size_t i = 0; i < a.size(); ++i)
    ++counts[static_cast<std::size_t>(a[i] * 16) * 16 + static_cast<std::size_t>(b[i] * 16)];
  return chi_square(counts, expected).p;
}

// Every number of the first `pairs` pairs against every other of another pair, over pixels: one sample each, so that
// nothing but the scrambling makes them; and over the samples of one pixel, where only the shuffling parts them.
TEST(Samples, PairsAreIndependentOfEachOther) {
  constexpr int kPairs = 6;
  constexpr std::size_t kTests = 2 * kPairs * (2 * kPairs - 1) - kPairs;
  const double least = sidak(0.01, kTests);  // significance 1 % of all together; the seed is fixed
  for (const bool over_pixels : {true, false}) {
    std::array<std::vector<float>, 2 * kPairs> numbers;
    // Over samples: many pixels with 8 samples of each, since one pixel's numbers are too regular for a chi-square.
    for (std::uint32_t i = 0; i < 40000; ++i) {
      Samples samples(over_pixels ? i : i / 8, over_pixels ? 3 : i % 8, 5);
      for (std::size_t k = 0; k < kPairs; ++k) {
        const glm::vec2 u = samples.next();
        numbers[2 * k].push_back(u.x), numbers[2 * k + 1].push_back(u.y);
      }
    }
    for (std::size_t i = 0; i < numbers.size(); ++i)
      for (std::size_t k = i + 1; k < numbers.size(); ++k) {
        if (i / 2 == k / 2 && !over_pixels) continue;
        EXPECT_GE(p_of_independence(numbers[i], numbers[k]), least) << i << " " << k << " " << over_pixels;
      }
  }
}

// A product of functions of several pairs has the mean that independence gives: within one pixel, at many samples, the
// shuffles must not line up. 2000 seeds of 64 samples; the mean of all against 1/4 by its standard error.
TEST(Samples, OfOnePixelMakeUnbiasedProducts) {
  for (const int apart : {1, 2, 5}) {
    double sum = 0, square = 0;
    constexpr int kSeeds = 2000;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      double mean = 0;
      for (std::uint32_t i = 0; i < 64; ++i) {
        Samples samples(9, i, seed);
        const float a = samples.next().x;
        for (int k = 1; k < apart; ++k) samples.next();
        mean += static_cast<double>(a * samples.next().x) / 64;
      }
      sum += mean, square += mean * mean;
    }
    const double mean = sum / kSeeds, error = std::sqrt((square / kSeeds - mean * mean) / (kSeeds - 1));
    EXPECT_LT(std::abs(mean - 0.25), 3.5 * error) << apart;  // 3.5 sigma: 0.05 % for each of three
    EXPECT_LT(error, 1e-3) << apart;                         // independent numbers: 0.22 / sqrt(128000) = 6e-4
  }
}

TEST(Samples, OfNeighboringPixelsAreIndependent) {
  std::vector<float> here, next, below, other_seed;
  for (std::uint32_t i = 0; i < 65536; ++i) {
    here.push_back(Samples(i, 0, 1).next().x), next.push_back(Samples(i + 1, 0, 1).next().x);
    below.push_back(Samples(i + 256, 0, 1).next().x), other_seed.push_back(Samples(i, 0, 2).next().x);
  }
  const double least = sidak(0.01, 3);  // significance 1 % of the three
  EXPECT_GE(p_of_independence(here, next), least);
  EXPECT_GE(p_of_independence(here, below), least);
  EXPECT_GE(p_of_independence(here, other_seed), least);
}

// The picture of another seed is not the same one moved.
TEST(Samples, OfAnotherSeedAreThoseOfNoOtherPixel) {
  for (std::uint32_t pixel = 0; pixel < 64; ++pixel)
    for (std::uint32_t other = 0; other < 4096; ++other)
      for (const std::uint32_t seed : {1u, 2u, 1000u})
        ASSERT_NE(Samples(pixel, 0, 0).next(), Samples(other, 0, seed).next()) << pixel << " " << other << " " << seed;
}

TEST(Samples, PlainNumbersAreUniformAndIndependentOfThePairs) {
  std::vector<float> plain, before, after, other;
  for (std::uint32_t i = 0; i < 65536; ++i) {
    Samples samples(i / 16, i % 16, 3);
    before.push_back(samples.next().x), plain.push_back(samples.next_plain());
    other.push_back(samples.next_plain()), after.push_back(samples.next().y);
  }
  const double least = sidak(0.01, 3);  // significance 1 % of the three
  EXPECT_GE(p_of_independence(plain, before), least);
  EXPECT_GE(p_of_independence(plain, after), least);
  EXPECT_GE(p_of_independence(plain, other), least);
}

TEST(Samples, ASkippedPairLeavesTheOthersAsTheyAre) {
  Samples a(7, 11, 13), b(7, 11, 13);
  for (int k = 0; k < 3; ++k) a.next();
  b.next(), b.skip(), b.skip();
  EXPECT_EQ(a.next(), b.next());
}

TEST(Samples, IntegrateASmoothFunctionFarBetterThanRandomOnes) {
  // Owen's scrambling: variance below 1 / n^3 for smooth functions, so 256 samples of x y are within 1e-4 or so of 1/4.
  double worst = 0;
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    double sum = 0;
    for (const glm::vec2& p : points(0, seed, 3, 0, 256)) sum += static_cast<double>(p.x * p.y) / 256;
    worst = std::max(worst, std::abs(sum - 0.25));
  }
  EXPECT_LT(worst, 1.5e-3);  // random numbers: 0.22 / 16 = 1.4e-2
}

}  // namespace
}  // namespace likeness::sampling
