#include "fit/kernel_loops.h"

namespace likeness::fit {
Kernels kernels_avx512() { return loops::kernels_of<xsimd::default_arch>("avx512"); }
}  // namespace likeness::fit
