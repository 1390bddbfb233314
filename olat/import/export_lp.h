#pragma once

#include <filesystem>
#include <string>

#include "render/capture/capture.h"

namespace likeness::olat_import {

struct Exported {
  std::size_t lights = 0, near = 0, left_out = 0;  // near: their direction is that from the world's origin
};

// An .lp of one camera's photographs, in its own axes (x right, y up, z towards it), so that PTM, HSH or RBF can be fitted
// to the same data elsewhere. Names of files are relative to the .lp where that is possible. Lights without a place or
// without a photograph are left out.
Exported export_lp(const capture::Capture& capture, std::size_t camera, const std::filesystem::path& file);

}  // namespace likeness::olat_import
