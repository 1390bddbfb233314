#pragma once

#include <cstdint>
#include <string>
#include <vector>

// Picture files made byte by byte from their definitions, so that no library both writes and reads them.
namespace likeness::image::test {

// PNG: color type 0 grey, 2 RGB, 4 grey and alpha, 6 RGBA; `samples` row by row, 16-bit ones as they are.
std::string png_file(int width, int height, int bits, int color_type, const std::vector<std::uint16_t>& samples);

// TGA, uncompressed, 24 or 32 bit, from RGB(A) bytes, top row first or (as most programs do) last.
std::string tga_file(int width, int height, const std::vector<std::uint8_t>& samples, bool is_top_first);

// PFM, little endian, from floats top row first (the file has the bottom row first).
std::string pfm_file(int width, int height, int channels, const std::vector<float>& samples);

// Radiance HDR, flat scan lines, from RGBE quadruples.
std::string hdr_file(int width, int height, const std::vector<std::uint8_t>& rgbe);

// A grey JPEG of one block of 8 x 8, every pixel 192.
std::string jpeg_file();

}  // namespace likeness::image::test
