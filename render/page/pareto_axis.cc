#include "render/page/pareto_axis.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace likeness::page {

bool Axis::in_strip(double value) const {
  if (!is_broken) return false;
  return strip_is_low ? std::log10(value) < low : std::log10(value) > high;
}

double Axis::at(double value) const {
  if (in_strip(value)) {
    const double share = strip_high > strip_low ? (std::log10(value) - strip_low) / (strip_high - strip_low) : 0.5;
    return strip_from + share * (strip_to - strip_from);
  }
  return from + (std::log10(value) - low) / (high - low) * (to - from);
}

std::vector<std::pair<double, double>> Axis::ticks() const {
  std::vector<std::pair<double, double>> out;
  const bool fine = high - low < 2.6, finest = high - low < 0.8;
  for (int e = int(std::floor(low)); e <= int(std::ceil(high)); ++e)
    for (const double digit : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0}) {
      const double value = digit * std::pow(10.0, e), place = std::log10(value);
      const bool is_usual = digit == 1 || (fine && (digit == 2 || digit == 5));
      if (place < low || place > high || !(is_usual || finest)) continue;
      out.emplace_back(value, at(value));
    }
  return out;
}

Axis axis_over(std::vector<double> values, bool strip_is_low, double gap, double pad, double from, double to,
               double strip_size) {
  for (double& value : values) value = std::log10(value);
  std::sort(values.begin(), values.end());
  if (strip_is_low) std::reverse(values.begin(), values.end());
  Axis axis;
  axis.strip_is_low = strip_is_low;
  std::size_t kept = 1;
  while (kept < values.size() && std::abs(values[kept] - values[kept - 1]) <= gap) ++kept;
  axis.is_broken = kept < values.size();
  const auto [least, most] = std::minmax(values.front(), values[kept - 1]);
  // A single value still needs some room around it.
  const double more = std::max(pad, 0.5 * (0.6 - (most - least)));
  axis.low = least - more, axis.high = most + more;
  axis.from = from, axis.to = to;
  if (axis.is_broken) {
    const double size = to > from ? strip_size : -strip_size;
    if (strip_is_low) axis.from += size;
    else axis.to -= size;
    std::tie(axis.strip_low, axis.strip_high) = std::minmax(values[kept], values.back());
    const double start = strip_is_low ? from : to - size;
    axis.strip_from = start + 0.25 * size, axis.strip_to = start + 0.75 * size;
  }
  return axis;
}

}  // namespace likeness::page
