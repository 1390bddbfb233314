#pragma once

#include <span>
#include <string>
#include <vector>

#include "olat/metric/metric.h"
#include "olat/pair/picture.h"
#include "olat/pair/state.h"
#include "olat/view/half_picture.h"

// What a report shows of one pair: small pictures to look at, and the maps that a browser cannot make.
namespace likeness::olat_view {

struct Crop {
  int x = 0, y = 0, width = 0, height = 0;  // within the pair [pixel]
};

HalfPicture cropped(const HalfPicture& from, const Crop& crop);

// FLIP and HDR-FLIP inside the crop, row by row; the pixels around it take part, as far as FLIP filters.
std::vector<float> flip_inside(const olat_pair::State& state, const olat_pair::Pair& pair, const Crop& crop);

// A link to the pair on the page itself, with photo, render, difference by the state's metric and FLIP as PNG of at most
// kThumbSide pixels a side. `flip` is flip_inside() of FLIP.
inline constexpr int kThumbSide = 176;
std::string pair_card(const olat_pair::State& state, const olat_pair::Pair& pair, const Crop& crop,
                      std::span<const float> flip, const metric::Summary& summary);

}  // namespace likeness::olat_view
