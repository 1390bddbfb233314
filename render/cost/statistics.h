#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace likeness::scene_cost {

// Between the two nearest values, in proportion. At least one value.
inline double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at), high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}
inline double median(const std::vector<double>& values) { return quantile(values, 0.5); }

}  // namespace likeness::scene_cost
