#include "brdf/realis/texels.h"
#include "tests/brdf/realis/texels_in_set.h"

namespace likeness::brdf {

TexelsInSet texels_avx512() {
  using B = realis_texels::Widest;
  return {&residuals<B, 1>, &residuals<B, 3>, &residuals<B, 1>, &residuals<B, 3>};
}

}  // namespace likeness::brdf
