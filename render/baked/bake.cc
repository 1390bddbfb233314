#include "render/baked/bake.h"

#include <algorithm>
#include <cmath>

#include "brdf/realis/coefficient.h"

namespace likeness::baked {
namespace {

// What four bits clip: fewer steps are better spent on the many.
constexpr double kWithin = 0.995;

}  // namespace

std::vector<double> multipliers_of(const Bake& bake) {
  const std::size_t each = bake.channel_count() * bake.basis.size();
  std::vector<double> out(each, 0.0);
  if (bake.bits != Bits::kFour) {
    for (std::size_t i = 0; i < bake.coefficients.size(); ++i)
      out[i % each] = std::max(out[i % each], static_cast<double>(std::abs(bake.coefficients[i])));
    return out;
  }
  std::vector<float> sizes;
  for (std::size_t k = 0; k < each; ++k) {
    sizes.clear();
    for (std::size_t i = k; i < bake.coefficients.size(); i += each) sizes.push_back(std::abs(bake.coefficients[i]));
    if (sizes.empty()) continue;
    const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(kWithin * static_cast<double>(sizes.size() - 1) + 0.5);
    std::nth_element(sizes.begin(), at, sizes.end());
    out[k] = static_cast<double>(*at);
  }
  return out;
}

std::size_t bytes_of_texel(const Bake& bake) {
  const std::size_t numbers = bake.kept * bake.channel_count();
  if (bake.bits == Bits::kFour) return (numbers + 1) / 2;
  return numbers + (bake.is_sparse() ? bake.kept : 0);
}

namespace {
struct Squares {
  int zero, steps;
};
Squares squares_of(Bits bits) {
  return bits == Bits::kFour ? Squares{kNibbleZero, 7} : Squares{brdf::kRealisZero, 127};
}
}  // namespace

std::uint8_t stored_of(double c, double multiplier, Bits bits) {
  if (bits == Bits::kEight) return brdf::encoded(c, multiplier);
  const Squares squares = squares_of(bits);
  const double x = std::abs(c) / multiplier;
  if (!(multiplier > 0) || std::isnan(x)) return static_cast<std::uint8_t>(squares.zero);
  const auto step = static_cast<int>(std::lround(squares.steps * std::sqrt(std::min(x, 1.0))));
  return static_cast<std::uint8_t>(squares.zero + (c < 0 ? -step : step));
}

double worth_of(std::uint8_t stored, double multiplier, Bits bits) {
  if (bits == Bits::kEight) return brdf::decoded(static_cast<double>(stored), multiplier);
  const Squares squares = squares_of(bits);
  const double x = static_cast<double>(stored - squares.zero) / squares.steps;
  return multiplier * x * std::abs(x);
}

Bake quantised(const Bake& bake) {
  Bake out = bake;
  const std::vector<double> multipliers = multipliers_of(bake);
  for (std::size_t i = 0; i < out.coefficients.size(); ++i) {
    const double m = multipliers[i % multipliers.size()], c = static_cast<double>(bake.coefficients[i]);
    out.coefficients[i] = static_cast<float>(worth_of(stored_of(c, m, bake.bits), m, bake.bits));
  }
  return out;
}

}  // namespace likeness::baked
