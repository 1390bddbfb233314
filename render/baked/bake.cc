#include "render/baked/bake.h"

#include <algorithm>
#include <cmath>

#include "brdf/realis/coefficient.h"

namespace likeness::baked {

std::vector<double> multipliers_of(const Bake& bake) {
  const std::size_t each = bake.channel_count() * bake.basis.lobes.size();
  std::vector<double> out(each, 0.0);
  for (std::size_t i = 0; i < bake.coefficients.size(); ++i)
    out[i % each] = std::max(out[i % each], static_cast<double>(std::abs(bake.coefficients[i])));
  return out;
}

std::size_t bytes_of_texel(const Bake& bake) {
  return bake.kept * bake.channel_count() + (bake.is_sparse() ? bake.kept : 0);
}

Bake quantised(const Bake& bake) {
  Bake out = bake;
  const std::vector<double> multipliers = multipliers_of(bake);
  for (std::size_t i = 0; i < out.coefficients.size(); ++i) {
    const double m = multipliers[i % multipliers.size()];
    const std::uint8_t byte = brdf::encoded(static_cast<double>(bake.coefficients[i]), m);
    out.coefficients[i] = static_cast<float>(brdf::decoded(static_cast<double>(byte), m));
  }
  return out;
}

}  // namespace likeness::baked
