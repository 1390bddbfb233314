#include "fit/kernel_loops.h"

namespace likeness::fit {
Kernels kernels_baseline() { return loops::kernels_of<xsimd::default_arch>("baseline"); }
}  // namespace likeness::fit
