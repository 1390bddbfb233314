#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include <glm/mat3x3.hpp>

#include "render/image/cie_lab.h"
#include "render/image/picture.h"

// A photographed chart of 24 patches (6 x 4, dark skin first, white to black last) against measured values of one.
namespace likeness::olat_calibrate {

inline constexpr int kPatchColumns = 6, kPatchRows = 4;
inline constexpr std::size_t kPatches = 24, kFirstGrey = 18;  // 18 to 23: white to black

struct Reference {
  std::array<image::Lab, kPatches> lab;  // of CIE D50
  std::string_view space;                // what the file held: "Lab" or "xyY"
};

// A table with a header and 24 rows of patch (1 to 24), c0, c1, c2: CIELAB, or x, y and Y from 0 to 1 (what all rows fit
// into is taken for that). For D50, as charts are published. Throws files::InputError, one line with the file and line.
Reference read_reference(const std::filesystem::path& file);
Reference reference_of(std::string_view text, const std::string& name);

// Pixel coordinates (0 is the left or upper edge of the first pixel) of the chart's outer corners: that of patch 1, then
// of 6, of 24 and of 19.
using Corners = std::array<std::array<double, 2>, 4>;

// The median of each patch's middle, through the perspective of the corners. Throws files::UsageError: corners that are
// no convex quadrangle, or lie outside the picture.
std::array<std::array<double, 3>, kPatches> patches_of(const image::Picture& photo, const Corners& corners);

struct Stage {
  std::string_view name;
  double mean = 0, largest = 0;  // Delta E 2000
  std::size_t worst = 0;         // patch, from 0
};

// Three steps from the light of a photo to that of the reference, each judged: as it comes, but for one exposure; white
// balanced (Bradford, by the six greys); by the best matrix. The last minimises the fourth powers of Delta E 2000, so that
// the worst patch counts.
struct ChartFit {
  std::array<Stage, 3> stages{Stage{"in"}, Stage{"white balanced"}, Stage{"matrix"}};
  std::array<std::array<double, kPatches>, 3> delta_e{};
  double exposure_ev = 0;  // of all stages [stop]; no part of the matrix
  glm::dmat3 balance{1};   // of the second stage, acts on column vectors of linear Rec. 709
  glm::dmat3 matrix{1};    // of the third; both keep the luminance of the greys
};
ChartFit fit_chart(const std::array<std::array<double, 3>, kPatches>& patches, const Reference& reference);

}  // namespace likeness::olat_calibrate
