#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "render/capture/capture.h"

// The files of a capture: capture.json, cameras.json, lights.json, frames.json in one folder (docs/capture.md).
namespace likeness::capture {

// What a hostile file may cost.
inline constexpr std::size_t kMostCameras = 4096, kMostLights = 16384, kMostVariants = 256, kMostFrames = 1 << 20,
                             kMostPairs = 1 << 22;                      // of a camera and a light
inline constexpr std::size_t kMostCaptureBytes = std::size_t{1} << 28;  // of each file

// A folder with capture.json, or that file itself. Opens no picture. Throws files::InputError, one line with the file and
// the line: an unknown key (with the nearest), an id that is not there or twice, a number out of range, a path that
// leaves the root by ".." (absolute paths are allowed in frames and layers: originals may lie elsewhere).
Capture read_capture(const std::filesystem::path& path);

// The same from the texts of the files; `root` is for paths and messages only.
struct CaptureTexts {
  std::string capture, cameras, lights, frames;
};
Capture capture_of(const CaptureTexts& texts, const std::filesystem::path& root);

CaptureTexts texts_of(const Capture& capture);

// Writes the four files, each whole; capture.json last, so that a folder without it is no capture. Throws
// std::invalid_argument for values that read_capture would refuse.
void write_capture(const Capture& capture);

}  // namespace likeness::capture
