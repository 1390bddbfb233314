#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render/capture/capture.h"

// Photographs that somebody else has taken and listed, as a capture (docs/capture.md) beside them.
namespace likeness::olat_import {

struct ImportOptions {
  std::string path;           // a folder, or a list of lights in one
  std::string out;            // folder of the capture; empty: NAME.capture in the current folder
  std::string lights;         // a list of lights, if it is not in the folder
  std::string cameras;        // a folder of COLMAP, if it is not the folder
  std::string photos;         // with cameras of COLMAP: files with {camera} and {light}, relative to the folder
  std::string mask, normals;  // files; empty: looked for by their names
  std::string color_space;    // a word of kColorSpaces; empty: as the format or the list says, or else refused
  std::optional<double> black, white, clip;
  double picture_width_m = 1;  // what an orthographic picture spans
  double unit_m = 0;           // length of the unit of .dome and COLMAP [m]; 0: not said
  bool copies = false, hashes = false, overwrites = false;
};

struct Import {
  capture::Capture capture;
  std::vector<std::string> notes;    // what was found and what was assumed, a line each
  std::vector<std::string> missing;  // files that the list names and that are not there
};

// Reads one photograph of each camera for its size, and writes the capture's files and, if asked, copies. Throws
// files::UsageError (what the user must say) and files::InputError.
Import bring(const ImportOptions& options);

}  // namespace likeness::olat_import
