#include "tests/brdf/parity_lanes.h"

void likeness::brdf::parity::with_sse2(const float* columns, float* f) { evaluate<xsimd::sse2>(columns, f); }
