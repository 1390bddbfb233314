#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/runtime/settings.h"

// A quality file: the settings of a frame, as `likeness cost --quality` picks them and `likeness render --quality` takes
// them. JSON:
//
//   {"format": "likeness quality", "version": 1, "settings": {"pixel_samples": 4, "environment": "rays16"}, ...}
//
// A setting that is left out keeps its default. `scene`, `camera` and `measured` say where the choice comes from, and
// are not read.
namespace likeness::runtime {

// Throws files::InputError, one line with the file's name and the line number: what is no quality file, another version,
// an unknown setting or level with the nearest name.
Settings read_quality(const std::filesystem::path& file);
Settings parse_quality(std::string_view text, const std::string& source);

// What a choice is based on; names and units are the writer's.
struct QualityOrigin {
  std::string scene, camera;
  std::vector<std::pair<std::string, double>> measured;
};
// The seed is not in it. Throws std::runtime_error for what cannot be written.
void write_quality(const std::filesystem::path& file, const Settings& settings, const QualityOrigin& origin);
std::string quality_text(const Settings& settings, const QualityOrigin& origin);

}  // namespace likeness::runtime
