#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/image/cie_lab.h"
#include "render/photograph/demosaic.h"
#include "render/photograph/tiff_tags.h"

// Camera raw to linear light: no tone curve, nothing brightened, nothing cut off but what the sensor cut off, which is said.
namespace likeness::photograph {

using Rgb3 = std::array<double, 3>;

// What a DNG says about its mosaic (Adobe, DNG 1.7, chapter 4).
struct DngFacts {
  std::string camera;  // make and model
  Pattern pattern{{{0, 1}, {1, 2}}};
  std::array<std::array<double, 2>, 2> black{};  // BlackLevel of each site of the cell [count]
  double white = 0;                              // WhiteLevel [count]: a site at or above it is full
  int orientation = 1;                           // of EXIF, 1 to 8
  std::optional<Rgb3> as_shot;                   // gains that make a grey grey, the least of them 1
  Rgb3 daylight{1, 1, 1};                        // the same for D65, by the matrix
  // To linear Rec. 709 from the balanced camera; rows add to 1, so a grey stays grey. The identity if the file has no matrix.
  image::Matrix3 rec709_from_camera{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  bool has_matrix = false;
  double baseline_ev = 0;  // BaselineExposure, which is not applied
  Taken taken;
};

// Throws files::InputError, one line that begins with `name`: no DNG, a mosaic that is not Bayer's, levels that make no sense.
// Of two matrices that for D65 is taken, else the second.
DngFacts facts_of_dng(std::string_view bytes, const std::string& name);

enum class Balance : unsigned char { kAsShot, kDaylight, kGains, kNone };

struct RawOptions {
  Balance balance = Balance::kAsShot;  // without a white balance as shot: that of daylight
  Rgb3 gains{1, 1, 1};                 // of kGains: above 0, finite
  bool is_camera_space = false;        // leave out the matrix
};

struct Developed {
  DngFacts facts;
  Rgb3 gains{1, 1, 1};  // that were applied, the least of them 1
  // Linear light, upright. 1 is a full sensor in the channel of the least gain. Noise about black stays, below 0 too.
  image::Picture light;
  // 1 where a site that the pixel was made of was full, else 0. There no channel of the camera is above 1, so what was too
  // bright is white; it was that bright or brighter.
  std::vector<std::uint8_t> is_clipped;
  std::size_t clipped = 0;
};

// The steps: less black, by white less black; white balance; demosaic; what is full to at most 1; matrix; orientation.
// Throws files::InputError, and files::UsageError for gains that are none, or no balance with a matrix.
Developed develop(std::string_view bytes, const std::string& name, const RawOptions& options = {});

}  // namespace likeness::photograph
