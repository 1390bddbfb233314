#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "render/image/picture.h"
#include "render/image/texels.h"

// Pictures from files and from memory. What a file is, its first bytes say, not its name (a TGA alone has none that do,
// and is known by its extension).
//
//   EXR                    through OpenEXR's own interface: scan lines or tiles, one part or many, half, float or uint
//                          (as numbers). The picture is the display window; it is 0 where the data window leaves it bare.
//   PNG, JPEG, TIFF, TGA,  through OpenImageIO, which the first of them loads: 8-bit files as
//   HDR, PFM and PNM, BMP, bytes, deeper ones as floats (integers divided by their largest, so 65535 is 1). Alpha is
//   WebP, DDS, PSD         not multiplied into the colors.
//   DNG (camera raw)       through LibRaw, which OpenImageIO has: linear light with Rec. 709 primaries. Black and white
//                          level, the camera's matrix and its white balance as shot are taken from the file, 1 is a full
//                          sensor; what is below black or outside those primaries is 0.
//
// A process that links OpenImageIO spends 0.28 CPU s before main, so it lives in the module likeness_image_io.so, which
// render/files/module.h says how to find.
//
// Values are those of the file: transfer curves are not undone, NaN and infinity are kept. All throw
// files::InputError, one line that begins with the name, for what is absent, damaged or beyond the limits; memory is
// asked for only when the limits hold.
namespace likeness::image {

inline constexpr std::size_t kMostTexels = std::size_t{1} << 28;     // 16384 x 16384
inline constexpr int kLongestSide = 1 << 16;                         // of either
inline constexpr std::size_t kMostFileBytes = std::size_t{1} << 32;  // 4 GB

struct ReadOptions {
  // EXR: the layer, for example "diffuse" of diffuse.R, diffuse.G, diffuse.B, or the part of that name. Empty: the
  // channels without a layer, or else the only layer. Channels are taken as R G B A (what is missing of R, G and B is 0),
  // or Y A, or X Y Z, or the only one there is.
  std::string layer{};
  std::size_t most_texels = kMostTexels;
};

Texels read_texels(const std::filesystem::path& file, const ReadOptions& options = {});

// The same of a file in memory; `name` is for messages and, for TGA, its extension.
Texels decode_texels(std::string_view bytes, const std::string& name, const ReadOptions& options = {});

// Whether bytes begin as a TIFF does that is camera raw (DNG).
bool is_dng(std::string_view bytes);

// A DNG as its sensor counted it: one channel of whole numbers, without the sensor's covered edge; neither black nor white
// is applied, nor the orientation.
Texels decode_mosaic(std::string_view bytes, const std::string& name, const ReadOptions& options = {});

// Linear light of a file: floats as they are, bytes decoded by the sRGB curve, grey repeated, alpha left out.
Picture read_picture(const std::filesystem::path& file, const ReadOptions& options = {});

// The same of texels.
Picture picture_of(Texels texels);

}  // namespace likeness::image
