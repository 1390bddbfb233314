#include "render/expose/shrink.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace likeness::expose {

image::Picture shrunk(const image::Picture& picture, int longest) {
  const int side = std::max(picture.width, picture.height);
  if (side <= longest) return picture;
  const auto smaller = [&](int size) {
    return std::max(1, static_cast<int>(static_cast<double>(size) * longest / side + 0.5));
  };
  image::Picture out(smaller(picture.width), smaller(picture.height));
  const auto first = [](int i, int to, int from) { return static_cast<int>(static_cast<long>(i) * from / to); };
  tbb::parallel_for(tbb::blocked_range<int>(0, out.height), [&](const auto& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < out.width; ++x) {
        double sum[3] = {0, 0, 0};
        long count = 0;
        for (int v = first(y, out.height, picture.height); v < first(y + 1, out.height, picture.height); ++v)
          for (int u = first(x, out.width, picture.width); u < first(x + 1, out.width, picture.width); ++u) {
            const auto rgb = picture.at(u, v);
            if (!std::isfinite(rgb[0]) || !std::isfinite(rgb[1]) || !std::isfinite(rgb[2])) continue;
            for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(rgb[c]);
            ++count;
          }
        for (std::size_t c = 0; c < 3 && count > 0; ++c)
          out.at(x, y)[c] = static_cast<float>(sum[c] / static_cast<double>(count));
      }
  });
  return out;
}

}  // namespace likeness::expose
