#pragma once

#include <array>
#include <span>

#include "render/image/picture.h"

// From a Bayer mosaic to colors.
namespace likeness::photograph {

// The color (0 red, 1 green, 2 blue) under each site of a 2 x 2 cell, of which two on a diagonal are green.
using Pattern = std::array<std::array<int, 2>, 2>;  // [y][x]

bool is_bayer(const Pattern& pattern);
// "RGGB"
const char* pattern_name(const Pattern& pattern);

// Every channel at every site. What a site has is kept; the other two are the mean of their neighbors plus a part of the
// second difference of the site's own channel, so that edges which all channels share stay sharp. Linear: sums of light
// stay, negative noise too. The mosaic must be white balanced, so that a grey has no mosaic. It is mirrored at its edges.
//
// Source  Malvar, He and Cutler, "High-quality linear interpolation for demosaicing of Bayer-patterned color images",
//         ICASSP 2004, figure 2.
//
// Rows are shared among TBB's threads. At least 4 x 4 sites, else std::invalid_argument.
image::Picture demosaic(std::span<const float> mosaic, int width, int height, const Pattern& pattern);

}  // namespace likeness::photograph
