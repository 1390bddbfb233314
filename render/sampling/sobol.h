#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>

// Random numbers for pictures: the first two dimensions of Sobol's sequence, scrambled as Owen does, as many pairs as
// asked for. Any power of two of points is stratified in every elementary rectangle; pairs are independent of each other.
namespace likeness::sampling {

// Mixes the bits of x so that every bit of it changes half of those of the result. A bijection.
// Source  lowbias32 of Wellons 2018, "Prospecting for Hash Functions".
constexpr std::uint32_t mixed(std::uint32_t x) {
  x ^= x >> 16, x *= 0x7feb352du;
  x ^= x >> 15, x *= 0x846ca68bu;
  return x ^ (x >> 16);
}
constexpr std::uint32_t mixed(std::uint32_t a, std::uint32_t b) { return mixed(a ^ (b * 0x9e3779b9u + 0x85ebca6bu)); }

constexpr std::uint32_t reversed_bits(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

// Owen's scrambling of a number whose bits are reversed: each bit is flipped depending on those below it and the seed.
// Source  Laine and Karras 2011, with the constants that Vegdahl found (2021, "Building a Better LK Hash"); Burley 2020,
//         "Practical Hash-based Owen Scrambling" (JCGT 9(4)).
constexpr std::uint32_t owen_of_reversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  return x ^ (x * 0x53a22864u);
}

// Point `index` of Sobol's second dimension with its bits reversed: Pascal's triangle modulo 2 times the index, which is
// five steps because the triangle is self-similar. (The first dimension reversed is the index itself.)
constexpr std::uint32_t sobol_second_reversed(std::uint32_t index) {
  std::uint32_t x = index;
  x ^= (x & 0xaaaaaaaau) >> 1;
  x ^= (x & 0xccccccccu) >> 2;
  x ^= (x & 0xf0f0f0f0u) >> 4;
  x ^= (x & 0xff00ff00u) >> 8;
  return x ^ (x >> 16);
}

// 32 bits to [0, 1): the float is never 1.
constexpr float unit(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

// The numbers of one sample of one pixel, in the order in which they are asked for.
class Samples {
 public:
  // `index` counts the pixel's samples; `pixel` and `seed` choose the scrambling.
  Samples(std::uint32_t pixel, std::uint32_t index, std::uint32_t seed)
      : seed_(mixed(pixel, seed)), index_(reversed_bits(index)) {}

  // In [0, 1)^2. Always inlined: several of them overlap, and calls would keep them apart.
  [[gnu::always_inline]] glm::vec2 next() {
    const std::uint32_t seed = mixed(seed_, pair_++);
    const std::uint32_t index = reversed_bits(owen_of_reversed(index_, seed));
    const std::uint32_t x = owen_of_reversed(index, mixed(seed + 1));
    const std::uint32_t y = owen_of_reversed(sobol_second_reversed(index), mixed(seed + 2));
    return {unit(reversed_bits(x)), unit(reversed_bits(y))};
  }

  // Leaves a pair out, for nothing: who does not need one asks for the rest in the same order.
  void skip() { ++pair_; }

  // In [0, 1): one number without a pattern, at a fifth of the price.
  float next_plain() { return unit(mixed(mixed(seed_ ^ index_, pair_++))); }

 private:
  std::uint32_t seed_, index_, pair_ = 0;
};

}  // namespace likeness::sampling
