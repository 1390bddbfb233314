#include "brdf/cost/peak.h"

#include <array>
#include <memory>

#include "brdf/cost/peak_loops.h"

namespace likeness::cost {

// In files that CMake makes, one for each instruction set.
void multiply_adds_baseline(float*);
void exponentials_baseline(const float*, float*);
void logarithms_baseline(const float*, float*);
void divisions_baseline(const float*, float*);
void roots_baseline(const float*, float*);
#ifdef __x86_64__
void multiply_adds_avx2(float*);
void exponentials_avx2(const float*, float*);
void logarithms_avx2(const float*, float*);
void divisions_avx2(const float*, float*);
void roots_avx2(const float*, float*);
void multiply_adds_avx512(float*);
void exponentials_avx512(const float*, float*);
void logarithms_avx512(const float*, float*);
void divisions_avx512(const float*, float*);
void roots_avx512(const float*, float*);
#endif

namespace {

using OverValues = void (*)(const float*, float*);
struct Loops {
  void (*multiply_adds)(float*);
  OverValues exponentials, logarithms, divisions, roots;
  std::size_t lanes;
};

struct Buffers {
  std::array<float, kChains * kWidest> chains{};
  std::array<float, kValues> any{}, positive{}, out{};
};

Peak peak_with(const Loops& loops) {
  auto buffers = std::make_shared<Buffers>();
  for (std::size_t i = 0; i < kValues; ++i) {
    buffers->any[i] = -8 + 16 * float(i) / float(kValues);
    buffers->positive[i] = 0.01f + float(i) / float(kValues);
  }
  const auto over = [&](OverValues loop, const std::array<float, kValues>& in) {
    return [buffers, loop, &in] { loop(in.data(), buffers->out.data()); };
  };
  return {[=] { loops.multiply_adds(buffers->chains.data()); },
          kRounds * kChains * loops.lanes,
          over(loops.exponentials, buffers->any),
          over(loops.logarithms, buffers->positive),
          over(loops.divisions, buffers->positive),
          over(loops.roots, buffers->positive),
          kValues};
}

}  // namespace

Peak peak_of(std::string_view set) {
#ifdef __x86_64__
  if (set == "avx512")
    return peak_with(
        {multiply_adds_avx512, exponentials_avx512, logarithms_avx512, divisions_avx512, roots_avx512, 16});
  if (set == "avx2")
    return peak_with({multiply_adds_avx2, exponentials_avx2, logarithms_avx2, divisions_avx2, roots_avx2, 8});
#endif
  static_cast<void>(set);
  return peak_with(
      {multiply_adds_baseline, exponentials_baseline, logarithms_baseline, divisions_baseline, roots_baseline, 4});
}

}  // namespace likeness::cost
