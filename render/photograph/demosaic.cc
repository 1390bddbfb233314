#include "render/photograph/demosaic.h"

#include <stdexcept>

#include <tbb/parallel_for.h>

namespace likeness::photograph {
namespace {

// Weights over the 5 x 5 sites around, in sixteenths; the site itself is in the middle.
using Filter = std::array<std::array<int, 5>, 5>;
constexpr Filter kGreenAtOther{
    {{0, 0, -2, 0, 0}, {0, 0, 4, 0, 0}, {-2, 4, 8, 4, -2}, {0, 0, 4, 0, 0}, {0, 0, -2, 0, 0}}};
// At green, the color that its row has; that of its column is the same turned.
constexpr Filter kOfRow{{{0, 0, 1, 0, 0}, {0, -2, 0, -2, 0}, {-2, 8, 10, 8, -2}, {0, -2, 0, -2, 0}, {0, 0, 1, 0, 0}}};
constexpr Filter kOfColumn{
    {{0, 0, -2, 0, 0}, {0, -2, 8, -2, 0}, {1, 0, 10, 0, 1}, {0, -2, 8, -2, 0}, {0, 0, -2, 0, 0}}};
// Red at blue, and blue at red.
constexpr Filter kOfDiagonal{
    {{0, 0, -3, 0, 0}, {0, 4, 0, 4, 0}, {-3, 0, 12, 0, -3}, {0, 4, 0, 4, 0}, {0, 0, -3, 0, 0}}};

// Mirrored about the edge's own site, which keeps the phase of the mosaic.
int mirrored(int i, int size) { return i < 0 ? -i : i >= size ? 2 * size - 2 - i : i; }

}  // namespace

bool is_bayer(const Pattern& p) {
  const bool first = p[0][0] == 1 && p[1][1] == 1 && p[0][1] + p[1][0] == 2 && p[0][1] != 1;
  return first || (p[0][1] == 1 && p[1][0] == 1 && p[0][0] + p[1][1] == 2 && p[0][0] != 1);
}

const char* pattern_name(const Pattern& p) {
  if (p[0][0] == 1) return p[0][1] == 0 ? "GRBG" : "GBRG";
  return p[0][0] == 0 ? "RGGB" : "BGGR";
}

image::Picture demosaic(std::span<const float> mosaic, int width, int height, const Pattern& pattern) {
  if (width < 4 || height < 4 || mosaic.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw std::invalid_argument("demosaic: at least 4 x 4 sites");
  image::Picture out(width, height);
  tbb::parallel_for(0, height, [&](int y) {
    std::array<const float*, 5> rows{};
    for (int j = 0; j < 5; ++j)
      rows[static_cast<std::size_t>(j)] =
          mosaic.data() + static_cast<std::size_t>(mirrored(y + j - 2, height)) * static_cast<std::size_t>(width);
    for (int x = 0; x < width; ++x) {
      std::array<int, 5> columns{};
      for (int i = 0; i < 5; ++i) columns[static_cast<std::size_t>(i)] = mirrored(x + i - 2, width);
      const auto filtered = [&](const Filter& filter) {
        float sum = 0;
        for (std::size_t j = 0; j < 5; ++j)
          for (std::size_t i = 0; i < 5; ++i)
            if (filter[j][i] != 0) sum += static_cast<float>(filter[j][i]) * rows[j][columns[i]];
        return sum / 16;
      };
      const auto& cell = pattern[static_cast<std::size_t>(y % 2)];
      const int own = cell[static_cast<std::size_t>(x % 2)];
      const auto pixel = out.at(x, y);
      pixel[static_cast<std::size_t>(own)] = rows[2][x];
      if (own == 1) {
        const auto of_row = static_cast<std::size_t>(cell[static_cast<std::size_t>((x + 1) % 2)]);
        pixel[of_row] = filtered(kOfRow);
        pixel[2 - of_row] = filtered(kOfColumn);
      } else {
        pixel[1] = filtered(kGreenAtOther);
        pixel[static_cast<std::size_t>(2 - own)] = filtered(kOfDiagonal);
      }
    }
  });
  return out;
}

}  // namespace likeness::photograph
