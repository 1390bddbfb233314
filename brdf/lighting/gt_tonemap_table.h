#pragma once

#include <array>
#include <cstddef>

#include "brdf/lighting/gt_tonemap.h"

namespace likeness::brdf {

// The Gran Turismo tonemapper of one set of parameters, from a table over the logarithm of scene light: one logarithm and
// two reads in place of a power and two exponentials.
//
// Source  this project's; the curve is GtTonemap's.
// Holds   within 1.4e-4 of the curve relative to y from 2^-14 on, at the defaults; never above P, and it rises where the
//         curve does, because it is linear between points of it. Below 2^-14 a line leads to the pedestal: y is then off
//         by less than 1e-6 of P. Every float has a value, as GtTonemap has it.
// Does not  have the curve's derivative: it is constant in the logarithm within each of the 511 intervals.
struct GtTonemapTable {
  static constexpr std::size_t kPoints = 512;  // 2 KB
  static constexpr double kLow = 0x1p-14;      // the first point; 1 stands for white
  double high = 32;                            // the last: beyond, y is P to 1e-7
  double pedestal = 0, per_log = 1;
  std::array<float, kPoints> y;

  explicit GtTonemapTable(const GtTonemap<double>& curve = {}) : pedestal(curve.pedestal) {
    const double room = (curve.max_brightness - curve.linear_start) * (1 - curve.linear_length);
    high = curve.shoulder_start() + 16 * room / curve.contrast;
    per_log = double(kPoints - 1) / std::log(high / kLow);
    for (std::size_t i = 0; i < kPoints; ++i)
      y[i] = static_cast<float>(curve.eval(kLow * std::exp(double(i) / per_log)));
  }

  template <Scalar S>
  S eval(const S& value) const {
    const S x = smaller(positive(value), constant<S>(high)), low = constant<S>(kLow);
    const S along = log(S(larger(x, low) / low)) * constant<S>(per_log);
    const S first = smaller(S(floor(along)), constant<S>(double(kPoints - 2)));
    const S share = smaller(S(along - first), S(1));
    const S before = at(y.data(), first), after = at(y.data(), S(first + S(1)));
    const S in_table = before + share * (after - before);
    const S start = constant<S>(pedestal);
    return pick(greater(low, x), S(start + (constant<S>(double(y[0])) - start) * (x / low)), in_table);
  }
};

}  // namespace likeness::brdf
