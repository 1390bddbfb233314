#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "render/capture/capture.h"

// The files that a bake read, as it names them, and their SHA-256.
namespace likeness::realis {

using Inputs = std::vector<std::pair<std::string, std::string>>;

// The capture's four files, and the layers of the cameras. Throw files::InputError for files that cannot be read.
Inputs inputs_of_capture(const capture::Capture& capture, std::span<const std::size_t> cameras);
// The photographs of a camera under some lights, and the renders of a variant.
Inputs inputs_of_pictures(const capture::Capture& capture, std::size_t camera, std::span<const std::size_t> lights,
                          std::optional<std::size_t> variant);

}  // namespace likeness::realis
