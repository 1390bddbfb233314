#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "realis/choose.h"
#include "render/baked/bake.h"

namespace likeness::realis {

// What `likeness realis bake` says when it is done.
struct Summary {
  baked::Space space = baked::Space::kImage;
  std::filesystem::path file;  // bake.json
  std::size_t texels = 0, lights = 0, cameras = 0, lobes = 0, bytes_of_texel = 0;
  double plain_rms = 0, left_rms = 0;  // of photo - render, of photo - (render + realis) [unit of the photo]
  std::vector<Choice> ladder;
  std::size_t chosen = 0;
  double reading_s = 0, baking_s = 0;
  std::size_t work_bytes = 0;  // on disk, while it lasted; 0: none
  std::vector<std::string> noticed;
};

std::string text_of(const Summary& summary);
std::string json_of(const Summary& summary);

}  // namespace likeness::realis
