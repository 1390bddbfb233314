#pragma once

#include <vector>

#include "olat/calibrate/chart.h"
#include "render/image/picture.h"

// Looks for charts of 24 patches in a photo.
namespace likeness::olat_calibrate {

struct FoundChart {
  Corners corners{};        // as patches_of takes them
  std::size_t patches = 0;  // of the 24 that were seen as quadrangles; the rest is where they must be
  double delta_e = 0;       // mean, of the best matrix: how well its colors are those of the reference
};

// Quadrangles of one tone that stand in a grid, of which the colors say which corner is which. Half of the patches must
// be seen; a mirrored chart is none. Best first. `photo` is linear light.
//
// Corners of a chart in focus are found to half a pixel (tests/olat/find_chart_test.cc); the smallest patch that is seen
// has 1/100 of the picture's longer side, the largest a sixth.
std::vector<FoundChart> find_charts(const image::Picture& photo, const Reference& reference);

}  // namespace likeness::olat_calibrate
