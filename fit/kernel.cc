#include "fit/kernel.h"

#include <cstdlib>
#include <string_view>

#include "render/files/files.h"

namespace likeness::fit {

Kernels kernels_baseline();
#ifdef __x86_64__
Kernels kernels_avx2();
Kernels kernels_avx512();
#endif

namespace {

Kernels choose() {
  const char* asked = std::getenv("LIKENESS_INSTRUCTION_SET");
  const std::string_view wanted = asked != nullptr ? asked : "";
  if (!wanted.empty() && wanted != "baseline" && wanted != "avx2" && wanted != "avx512")
    throw files::UsageError("LIKENESS_INSTRUCTION_SET = " + std::string(wanted) +
                            " is not one of baseline, avx2, avx512; unset it to use the fastest");
#ifdef __x86_64__
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512vl");
  if (avx512 && (wanted.empty() || wanted == "avx512")) return kernels_avx512();
  if (avx2 && (wanted.empty() || wanted == "avx2")) return kernels_avx2();
  if (wanted.empty() || wanted == "baseline") return kernels_baseline();
  throw files::UsageError("LIKENESS_INSTRUCTION_SET = " + std::string(wanted) +
                          " is not a set this processor has; unset it to use the fastest");
#else
  return kernels_baseline();
#endif
}

}  // namespace

const Kernels& kernels() {
  static const Kernels chosen = choose();
  return chosen;
}

}  // namespace likeness::fit
