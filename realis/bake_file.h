#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "realis/bake.h"
#include "render/json/section.h"

// A bake on disk: a folder with bake.json and pictures of the coefficients (docs/realis.md).
//
//     coefficients_000.png ...  8 bit RGB: one plane after the other, three a file. A byte b says (b - 128) / 127 of its lobe's
//                               multiplier; 0 says nothing was known there.
//     lobes_000.png ...         only if texels keep some lobes of many: which lobe each plane of coefficients is of, there
//     coefficients.exr          instead of both, where nothing was to be lost: a layer of floats a plane
//
// Planes are sorted by channel, then by lobe (or by place, if lobes are told apart by lobes_*.png).
namespace likeness::realis {

inline constexpr std::size_t kMostLobes = 256, kMostBakeBytes = std::size_t{1} << 26;  // of bake.json
inline constexpr int kBakeVersion = 1;

struct About {
  std::string capture, camera;                                // names
  std::vector<std::pair<std::string, std::string>> inputs{};  // files and their SHA-256
  std::vector<std::pair<std::string, double>> metrics{};
};

struct StoredBake {
  Bake bake;
  About about;
  int width = 0, height = 0;
  std::vector<std::uint32_t> pixels;  // of each texel
};

// What a texel costs, in bytes: coefficients, and lobes if they are told apart.
std::size_t bytes_of_texel(const Bake& bake);

// The bake as 8 bits hold it: what a reader of the pictures gets.
Bake quantised(const Bake& bake);

// Writes the pictures, then bake.json, each whole. Throws std::runtime_error.
void write_bake(const std::filesystem::path& folder, const StoredBake& stored, bool is_float);

// Throws files::InputError, one line with the file and the place: what is absent, damaged, too large or does not fit.
StoredBake read_bake(const std::filesystem::path& folder);

extern const json::Section kBakeSection;

}  // namespace likeness::realis
