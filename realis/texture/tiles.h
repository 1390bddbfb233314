#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>

#include "realis/bake.h"
#include "realis/texture/light_file.h"
#include "realis/texture/texel_surface.h"

// Texels solved, a tile after the other: 16384 texels that follow each other in the texture.
namespace likeness::realis {

inline constexpr std::size_t kTileTexels = std::size_t{1} << 14;

// What all tiles are solved with.
struct TileSolve {
  const capture::Capture& capture;
  const TexelSurface& surface;
  const std::vector<std::size_t>& lights;  // in Capture::lights
  const std::vector<LightFile>& samples;   // of each
  glm::dmat3 model_from_world;             // directions; what comes out is made unit
  Basis basis;
  Channels channels;
  double floor;
  std::size_t kept;            // lobes of each texel
  double mean_irradiance = 1;  // of the lights, where the object is
  std::string digest;

  std::size_t texels() const { return surface.positions.size(); }
  std::size_t channel_count() const { return channels == Channels::kRgb ? 3 : 1; }
  std::size_t planes() const { return channel_count() * kept; }
  std::size_t tiles() const { return (texels() + kTileTexels - 1) / kTileTexels; }
  std::size_t count_of(std::size_t tile) const { return std::min(kTileTexels, texels() - tile * kTileTexels); }
  bool is_sparse() const { return kept < basis.size(); }
};

// What a tile says of itself.
struct TileSums {
  double plain = 0, left = 0;  // of the squares of photo - render, and of photo - (render + realis)
  double samples = 0, unlit = 0;
  std::vector<double> largest;  // |coefficient|, channel by channel, the lobes
};

// Solves a tile and writes its file whole, unless it is there with this digest.
TileSums solve_tile(const TileSolve& solve, std::size_t tile, const std::filesystem::path& file);

// Of each texel of a tile that has been solved.
std::vector<std::uint8_t> known_of(const TileSolve& solve, std::size_t tile, const std::filesystem::path& file);
std::vector<float> plane_of(const TileSolve& solve, std::size_t tile, const std::filesystem::path& file,
                            std::size_t plane);
// Which lobe the plane's coefficients are of; only of a sparse bake.
std::vector<std::uint8_t> lobes_of(const TileSolve& solve, std::size_t tile, const std::filesystem::path& file,
                                   std::size_t place);

}  // namespace likeness::realis
