#pragma once

#include <cstddef>
#include <string>

#include "render/scene/scene.h"

namespace likeness::render_command {

// A SHA-256 of all that decides what camera `camera` sees of a scene: not of names, of the view, of the other cameras,
// nor of how its files are written.
std::string digest_of(const scene::Scene& scene, std::size_t camera);

}  // namespace likeness::render_command
