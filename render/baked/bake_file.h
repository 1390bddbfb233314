#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/baked/bake.h"
#include "render/image/layers.h"
#include "render/image/texels.h"

// A bake on disk: a folder with bake.json and pictures of the coefficients (docs/realis.md).
//
//     coefficients_000.png ...  8 bit RGB: one plane after the other, three a file. A byte b says (b - 128) / 127 of its lobe's
//                               multiplier; 0 says nothing was known there.
//                               "4 bit": two planes a byte, the first in its upper half; "8 bit squared": Bits
//     lobes_000.png ...         only if texels keep some lobes of many: which lobe each plane of coefficients is of, there
//     coefficients.exr          instead of both, where nothing was to be lost: a layer of floats a plane
//
// Planes are sorted by channel, then by lobe (or by place, if lobes are told apart by lobes_*.png).
namespace likeness::baked {

// Where a reader's bytes come from: files, or for scenes and fuzzers a table in memory. What they throw goes through.
struct Access {
  std::function<std::string(const std::filesystem::path& file, std::size_t limit)> bytes;
  std::function<image::Texels(const std::filesystem::path& file, std::size_t most_texels)> texels;
  std::function<image::Layers(const std::filesystem::path& file, std::size_t most_values)> layers;
  std::function<bool(const std::filesystem::path& file)> exists;
};
Access from_files();

inline constexpr std::size_t kMostPlaneBytes = std::size_t{1} << 32;    // of all planes of a bake
inline constexpr std::size_t kMostCoefficients = std::size_t{1} << 30;  // of a StoredBake, which holds zeros too

// What bake.json says: a bake without its coefficients.
struct Header {
  Bake bake;
  About about;
  int width = 0, height = 0;
  bool is_float = false;
  std::vector<double> multipliers;  // channel by channel, the lobes

  std::size_t count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  std::size_t planes() const { return bake.channel_count() * bake.kept; }
};
Header parse_header(std::string_view text, const std::string& source);

// The pictures that the header speaks of. Where a pixel is known (its first coefficient is not 0), its lobes are some of the
// header's.
struct Planes {
  std::vector<std::vector<std::uint8_t>> coefficients;  // channel by channel, `kept` planes of all pixels; or
  std::vector<std::vector<float>> floats;               // channel by channel, a plane for each lobe
  std::vector<std::vector<std::uint8_t>> lobes;         // `kept` planes; none: plane k is of lobe k
};
Planes read_planes(const std::filesystem::path& folder, const Header& header, const Access& access);

// Writes the pictures, then bake.json, each whole. Throws std::runtime_error.
void write_bake(const std::filesystem::path& folder, const StoredBake& stored, bool is_float);

// The same for who does not hold all coefficients at once: `head` has none, and is asked for three planes at a time (as
// floats: for all). Values are those of head.pixels, in their order.
struct PlaneSource {
  std::vector<double> multipliers;  // largest magnitudes; channel by channel, the lobes
  std::function<std::vector<float>(std::size_t plane)> coefficients;  // channel by channel, the kept lobes
  std::function<std::vector<std::uint8_t>(std::size_t place)> lobes;  // of a sparse bake: which lobe that one is of
};
void write_bake(const std::filesystem::path& folder, const StoredBake& head, const PlaneSource& source, bool is_float);

// The lobes that a texel keeps: those that are not 0 in some channel, in their order; fewer are filled up with others.
// `coefficients` channel by channel, the lobes (at most kMostLobes).
std::vector<std::uint8_t> kept_lobes(std::span<const float> coefficients, std::size_t channels, std::size_t kept);

// All readers throw files::InputError, one line with the file and the place: what is absent, damaged, too large or does
// not fit. Memory is asked for only when the limits hold.
StoredBake read_bake(const std::filesystem::path& folder, const Access& access = from_files());

}  // namespace likeness::baked
