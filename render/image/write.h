#pragma once

#include <filesystem>
#include <string>

#include "render/image/picture.h"

// Pictures to files. A file is whole or absent (files::write_whole). All throw std::runtime_error, one line.
//
// PNG is OpenImageIO's work. A process that links it spends 0.28 CPU s before main, so it lives in the module
// likeness_image_io.so, which the first PNG (or other picture that read.h leaves to it) loads. The module is searched in, and nowhere else:
//   1. the folder in the environment variable LIKENESS_MODULES, if that is set;
//   2. lib/likeness in the program's folder and the three above it: PREFIX/lib/likeness of an installed
//      PREFIX/bin/likeness, or that of the build folder; the module must have the program's owner, or root.
namespace likeness::image {

// A PNG in memory: 8 bit, RGB, tagged sRGB.
std::string png_bytes(const DisplayPicture& picture);

void write_png(const std::filesystem::path& file, const DisplayPicture& picture);

// Linear float RGB, ZIP compression, through OpenEXR's own interface: needs no module.
void write_exr(const std::filesystem::path& file, const Picture& picture);

}  // namespace likeness::image
