#pragma once

#include <algorithm>
#include <cmath>

// The shares by which a smaller picture is made of a larger one: each texel takes what it covers, so an odd side loses
// no row.
namespace likeness::texture {

// The side of the next level: half, rounded down, at least 1.
constexpr int half_of(int size) { return std::max(1, size / 2); }

// One axis: the texels of the finer level that a texel of the coarser covers, and how much of each.
struct Cover {
  int first = 0, last = 0;   // both included
  double low = 1, high = 1;  // shares of the first and of the last; those between count whole

  double share(int i) const {
    return i == first && i == last ? low + high - 1 : i == first ? low : i == last ? high : 1;
  }
};
inline Cover cover(int index, int fine, int coarse) {
  const double begin = static_cast<double>(index) * fine / coarse, end = static_cast<double>(index + 1) * fine / coarse;
  Cover c;
  c.first = static_cast<int>(std::floor(begin));
  c.last = std::min(static_cast<int>(std::ceil(end)), fine) - 1;
  c.low = c.first + 1 - begin, c.high = end - c.last;
  return c;
}

// Calls take(x, y, share) for each texel of the finer level that texel (column, row) of the coarser covers.
template <class F>
void for_covered(const Cover& columns, const Cover& rows, F&& take) {
  for (int y = rows.first; y <= rows.last; ++y)
    for (int x = columns.first; x <= columns.last; ++x) take(x, y, rows.share(y) * columns.share(x));
}

}  // namespace likeness::texture
