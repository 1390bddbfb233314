#include "fit/kernel_loops.h"

namespace likeness::fit {
Kernels kernels_avx2() { return loops::kernels_of<xsimd::default_arch>("avx2"); }
}  // namespace likeness::fit
