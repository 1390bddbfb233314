#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brdf/realis/mixes.h"
#include "brdf/realis/texel.h"
#include "render/baked/bake_file.h"
#include "render/baked/surface_maps.h"

// A bake as renderers read it: bytes, of eight lobes after another or of mixes.
namespace likeness::baked {

struct Residual {
  std::string name;  // the folder, for messages
  int width = 0, height = 0;
  float floor = 0.4f;          // what a cosine counts for at least
  std::size_t groups = 0;      // of eight lobes that each texel has; 0: the bake has no lobe
  brdf::RealisLobes lobes;     // their scale is of unit exposure, so that e stands beside the model's f [1/sr]
  std::size_t lobe_count = 0;  // of lobes.lobes
  std::size_t channels = 1;    // 1: of luminance; 3
  // `groups` of each pixel, row by row: the dominant lobes first. Unknown pixels are 0. One of the two is empty.
  std::vector<brdf::RealisTexel<1>> luminance;
  std::vector<brdf::RealisTexel<3>> rgb;
  // Of a bake of mixes instead of those: a byte a mix of each pixel, channel by channel. Unknown pixels decode to 0.
  brdf::RealisMixes mixes;
  std::vector<std::uint8_t> mixed;
  std::optional<Surface> surface;  // what it was baked over, of the same size; absent where the bake has none

  bool is_rgb() const { return channels == 3; }
  bool has_mixes() const { return !mixed.empty(); }
  std::size_t count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  std::size_t bytes() const;
};

// Reads a bake's folder. Coefficients that are stored as floats become bytes. Throws files::InputError as read_bake()
// does, for property maps of another size than the coefficients, and for more mixes than brdf::RealisMixes::kMost.
Residual read_residual(const std::filesystem::path& folder, const Access& access = from_files());

}  // namespace likeness::baked
