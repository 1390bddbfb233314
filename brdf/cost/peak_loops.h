#pragma once

#include <cstddef>

namespace likeness::cost {

inline constexpr std::size_t kChains = 12, kRounds = 512, kValues = 1024;
inline constexpr std::size_t kWidest = 16;  // lanes of any set

// state: kChains batches. Each round multiplies and adds once in every chain.
template <class B>
void multiply_adds(float* state) {
  B chain[kChains];
  for (std::size_t i = 0; i < kChains; ++i) chain[i] = B::load_unaligned(state + i * B::size);
  const B factor(0.999f), term(0.001f);
  for (std::size_t round = 0; round < kRounds; ++round)
    for (std::size_t i = 0; i < kChains; ++i) chain[i] = fma(chain[i], factor, term);
  for (std::size_t i = 0; i < kChains; ++i) chain[i].store_unaligned(state + i * B::size);
}

template <class B>
void exponentials(const float* in, float* out) {
  for (std::size_t i = 0; i < kValues; i += B::size) exp(B::load_unaligned(in + i)).store_unaligned(out + i);
}
template <class B>
void logarithms(const float* in, float* out) {
  for (std::size_t i = 0; i < kValues; i += B::size) log(B::load_unaligned(in + i)).store_unaligned(out + i);
}
template <class B>
void divisions(const float* in, float* out) {
  const B one(1.f);
  for (std::size_t i = 0; i < kValues; i += B::size) (one / B::load_unaligned(in + i)).store_unaligned(out + i);
}
template <class B>
void roots(const float* in, float* out) {
  for (std::size_t i = 0; i < kValues; i += B::size) sqrt(B::load_unaligned(in + i)).store_unaligned(out + i);
}

}  // namespace likeness::cost
