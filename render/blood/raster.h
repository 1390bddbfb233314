#pragma once

#include <array>
#include <vector>

#include "render/blood/drops.h"
#include "render/image/picture.h"

namespace likeness::blood {

// The stains as a decal: for each part how much of a pixel is covered [0, 1] and how thick the blood stands there [mm].
struct Decal {
  int size = 0;       // pixels a side
  double extent = 0;  // mm a side; the middle is where the axis meets the receiver, up is up
  std::array<std::vector<float>, kParts.size()> coverage, thickness;
  int outside = 0;  // drops whose stains do not touch the decal

  std::vector<float> all_coverage() const;   // of all parts together
  std::vector<float> all_thickness() const;  // their sum
};
inline constexpr int kMostDecalPixels = 8192;

// Ellipses with spined rims, sampled 4 x 4 a pixel; a stain below a pixel keeps its area and its volume. Thickness falls from
// the rim, where blood dries first, to the middle. size 1 or more; extent above 0.
Decal decal_of(const Spatter& spatter, int size, double extent);

// Over paper, with colors of the palette's defaults at the age of `time` seconds: opacity by thickness, 1 - 1/e at the palette's thickness.
image::Picture preview_of(const Decal& decal, double time);

}  // namespace likeness::blood
