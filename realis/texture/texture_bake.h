#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "realis/bake.h"
#include "realis/inputs.h"
#include "realis/noticed.h"
#include "realis/weight/table.h"
#include "render/capture/capture.h"
#include "render/scene/scene.h"

// The residual of a mesh in its own texture, from all cameras of a capture that see it (spec: Realis).
//
//   texels     triangles are drawn into a square of texels (unwrap.h), each with its place and normal on the mesh
//   sight      each camera's picture of each texel: where, how drawn out, and whether anything is between (sight.h)
//   samples    light by light: each picture is read, weighed and looked up by all texels that it shows; what all cameras
//              say of a texel under one light is one sum, since their residuals differ by a constant only (light_file.h)
//   lobes      chosen by texels that the seed draws
//   tiles      16384 texels at a time: least squares of each texel over all lights (tiles.h)
//   pictures   three planes at a time
//
// Samples and tiles are files below the bake's folder, each written whole. Whoever stops loses the piece at hand; the same
// request goes on with what is there, and ends with the same bytes. They are removed when the bake is written.
namespace likeness::realis {

struct TextureBakeOptions {
  BakeOptions bake;
  weight::Choice weights;
  std::size_t variant = 0;           // in Capture::variants: renders of the scene
  std::vector<std::size_t> cameras;  // in Capture::cameras; none: all that have photographs
  std::string object;                // name of the instance; may be empty if there is one only
  int resolution = 1024;             // texels a side, 1 to kMostResolution
  bool is_float = false;
  std::string scene_file;  // as bake.json has it
  Inputs inputs{};         // files that were read before
};

struct TextureBake {
  baked::Bake bake;  // without coefficients
  std::vector<Choice> ladder;
  std::size_t chosen = 0;
  Census census;
  std::size_t texels = 0, lights = 0, cameras = 0;
  std::size_t texels_of_cameras = 0;            // a texel counts as often as it is seen
  double plain_rms = 0, left_rms = 0;           // of photo - render, and of photo - (render + realis before rounding)
  double reading_s = 0, solving_s = 0;          // samples; tiles
  std::size_t work_bytes = 0;                   // on disk, while it lasts
  std::size_t kept_lights = 0, kept_tiles = 0;  // that were there from a request that was interrupted
};

// `folder` is the bake's. Throws files::UsageError for what cannot be baked (no renders: the command that makes them; no
// such object; no room on the disk), files::InputError for files, and files::Interrupted if `goes_on` says no.
TextureBake bake_texture(const capture::Capture& capture, const scene::Scene& scene, const TextureBakeOptions& options,
                         const std::filesystem::path& folder, const GoesOn& goes_on);

// Throws files::UsageError if `free` bytes are less than `needed`.
void must_have_room(const std::filesystem::path& folder, std::uintmax_t needed, std::uintmax_t free);

}  // namespace likeness::realis
