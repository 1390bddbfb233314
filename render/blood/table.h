#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/blood/palette.h"

// Colors of drops of blood, photographed as they age.
namespace likeness::blood {

enum class Encoding { kSrgb, kLinear };  // 0 to 255; reflectance of 0 to 4

struct Cell {
  std::string drop;
  double opacity = 0;           // [0, 1]
  double time = 0;              // [s], 0 to 1e8
  std::array<double, 3> rgb{};  // linear Rec. 709, background included
};

struct Table {
  std::string source;
  std::vector<Cell> cells;
};

// CSV with opacity, time_s, r, g, b, and drop if there is one. Throws files::InputError.
Table table_of(std::string_view bytes, const std::string& source, Encoding encoding);
Table read_table(const std::filesystem::path& file, Encoding encoding);
// The same as text, 8-bit sRGB, rounded to a hundredth.
std::string text_of(const Table& table);

// A made table of known truth: four drops at the talk's nine times (0 to 180 minutes), with relative noise of one standard
// deviation `noise` in each channel. The truth is the palette's defaults and a browning that its spectra do not know.
brdf::BloodPalette<double> example_truth();
std::array<double, 3> example_color(double opacity, double time);
Table example_table(double noise, std::uint64_t seed);

}  // namespace likeness::blood
