#include "tests/brdf/parity_lanes.h"

void likeness::brdf::parity::with_avx512(const float* columns, float* f) { evaluate<xsimd::avx512bw>(columns, f); }
