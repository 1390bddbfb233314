#pragma once

#include <filesystem>
#include <string>

#include "render/image/picture.h"

// Pictures to files. A file is whole or absent (files::write_whole). All throw std::runtime_error, one line.
namespace likeness::image {

// A PNG in memory: 8 bit, RGB, tagged sRGB.
std::string png_bytes(const DisplayPicture& picture);

void write_png(const std::filesystem::path& file, const DisplayPicture& picture);

// Linear float RGB, ZIP compression, through OpenEXR's own interface: needs no module.
void write_exr(const std::filesystem::path& file, const Picture& picture);

}  // namespace likeness::image
