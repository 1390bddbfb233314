#include "tests/brdf/parity_lanes.h"

void likeness::brdf::parity::with_avx2(const float* columns, float* f) {
  evaluate<xsimd::fma3<xsimd::avx2>>(columns, f);
}
