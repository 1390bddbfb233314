#pragma once

#include <filesystem>
#include <string>

#include "render/image/picture.h"

// Pictures to files. A file is whole or absent (files::write_whole). All throw std::runtime_error, one line.
namespace likeness::image {

// A PNG in memory: 8 bit, RGB, tagged sRGB.
std::string png_bytes(const DisplayPicture& picture);

void write_png(const std::filesystem::path& file, const DisplayPicture& picture);

// How a JPEG keeps three channels. None is thinned out (4:4:4).
enum class JpegColors : unsigned char {
  kYcc,  // as colors of pictures: luma, and differences in 8 bits
  kRgb   // each by itself: for channels that are no colors
};

// A JPEG in memory: 8 bit, baseline, no profile, which readers take as sRGB. `quality` of libjpeg, 1 to 100. At most 65500
// pixels a side.
std::string jpeg_bytes(const DisplayPicture& picture, int quality, JpegColors colors);

// Linear float RGB, ZIP compression, through OpenEXR's own interface: needs no module.
void write_exr(const std::filesystem::path& file, const Picture& picture);

}  // namespace likeness::image
