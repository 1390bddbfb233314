#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace likeness::datasets_synthetic {

// Random numbers that are the same on every machine: the engine's output is fixed by the C++ standard, the
// distributions of the standard library are not, so the transforms are written here. Each use takes a stream of
// its own, so that asking for one fault does not move the samples that another one hits.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(mixed(mixed(seed) + stream)) {}

  // Uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  bool chance(double probability) { return uniform() < probability; }

  // Normal with mean 0 and standard deviation 1: Box and Muller 1958, one of each pair. |normal()| < 8.6.
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));  // of (0, 1]: never log(0)
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  // Spreads neighboring seeds over all 64 bits. Source: Steele, Lea and Flood 2014, SplitMix64.
  static std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    return x ^ (x >> 31);
  }

  std::mt19937_64 engine_;
};

}  // namespace likeness::datasets_synthetic
