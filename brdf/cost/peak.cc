#include "brdf/cost/peak.h"

#include <array>
#include <memory>

#include "brdf/cost/peak_loops.h"

namespace likeness::cost {

// In files that CMake makes, one for each instruction set.
void multiply_adds_baseline(float*);
void exponentials_baseline(const float*, float*);
#ifdef __x86_64__
void multiply_adds_avx2(float*);
void exponentials_avx2(const float*, float*);
void multiply_adds_avx512(float*);
void exponentials_avx512(const float*, float*);
#endif

namespace {

struct Buffers {
  std::array<float, kChains * kWidest> chains{};
  std::array<float, kExponentials> in{}, out{};
};

Peak peak_with(void (*multiply_adds)(float*), void (*exponentials)(const float*, float*), std::size_t lanes) {
  auto buffers = std::make_shared<Buffers>();
  for (std::size_t i = 0; i < kExponentials; ++i) buffers->in[i] = -8 + 16 * float(i) / float(kExponentials);
  return {[=] { multiply_adds(buffers->chains.data()); }, kRounds * kChains * lanes,
          [=] { exponentials(buffers->in.data(), buffers->out.data()); }, kExponentials};
}

}  // namespace

Peak peak_of(std::string_view set) {
#ifdef __x86_64__
  if (set == "avx512") return peak_with(multiply_adds_avx512, exponentials_avx512, 16);
  if (set == "avx2") return peak_with(multiply_adds_avx2, exponentials_avx2, 8);
#endif
  static_cast<void>(set);
  return peak_with(multiply_adds_baseline, exponentials_baseline, 4);
}

}  // namespace likeness::cost
