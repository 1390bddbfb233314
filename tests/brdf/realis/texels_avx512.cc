#include "brdf/realis/texels.h"
#include "tests/brdf/realis/texels_in_set.h"

namespace likeness::brdf {

TexelsInSet texels_avx512() { return {&residuals<realis_texels::Widest, 1>, &residuals<realis_texels::Widest, 3>}; }

}  // namespace likeness::brdf
