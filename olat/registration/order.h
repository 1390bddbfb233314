#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "render/image/picture.h"

// Which light is which: pictures of one camera under many lights, compared by where they are bright.
namespace likeness::registration {

// What a picture under a light looks like, small: log2 of luminance in blocks, those that the weights have for more than a
// half, less the mean. A gain does not matter. Empty: black, or nothing inside.
using Sketch = std::vector<float>;
inline constexpr int kSketchSide = 64;  // blocks of the longer side, at most

Sketch sketch_of(const image::Picture& picture, std::span<const float> weight);

// Correlations of every photo (rows) with every render (columns), -1 to 1, row by row; 0 where either is empty. What all
// photos share, and what all renders share, is taken off first (four or more of each): color and shape then do not make
// every light look like every other. Sketches that are not empty have one size, else std::invalid_argument.
std::vector<double> likenesses(std::span<const Sketch> photos, std::span<const Sketch> renders);

// The column of each row of `score` (row by row, no more rows than columns, else std::invalid_argument) such that the sum
// is largest and no column is taken twice. O(rows^2 columns).
std::vector<std::size_t> assignment(const std::vector<double>& score, std::size_t rows, std::size_t columns);

struct Misplaced {
  std::size_t photo = 0, render = 0;  // positions: photo `photo` looks like render `render`
  double own = 0, found = 0;          // correlation with its own render, and with that
};

// photos[i] and renders[i] claim the same light. Names what is another's, if the correlation gains at least `margin`.
// An empty photo is left out; an empty render is nobody's.
std::vector<Misplaced> misplaced(std::span<const Sketch> photos, std::span<const Sketch> renders, double margin = 0.02);

// How the directions of lights would have to be turned over so that photos look as the cosine says.
struct Mirror {
  int flips = 0;              // bit 0: x, bit 1: y, bit 2: z changes its sign
  double own = 0, found = 0;  // mean correlation as stated, and with the flips
};
std::string_view flips_text(int flips);  // "x", "y and z", "none", ...

// Sketches of photos against max(0, N.L) of the normals (world, (0, 0, 0) where there is none) and the directions towards
// the lights (world). As many directions as photos, and photos with the weights of the normals, else
// std::invalid_argument.
Mirror mirror_of(const image::Picture& normals, std::span<const float> weight, std::span<const Sketch> photos,
                 std::span<const std::array<double, 3>> to_light);

}  // namespace likeness::registration
