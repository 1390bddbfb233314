#pragma once

#include <cstddef>
#include <string>

#include "render/scene/scene.h"

namespace likeness::render_command {

// The camera that `wanted` names: its name, or else its number counted from 0; empty: the first. Throws
// files::UsageError with those that there are.
std::size_t camera_of(const scene::Scene& scene, const std::string& wanted);

struct Size {
  int width = 0, height = 0;
};
// "640x360". Throws files::UsageError for what is no size, or one beyond scene::kMostPixels.
Size size_of(const std::string& text);

// Another size of the picture: what was seen from its top to its bottom still is, pixels keep their shape, and a wider
// picture sees more at its sides.
void resize(scene::Camera& camera, const Size& size);

// Bytes that rendering a picture of a size takes at most, besides the scene.
std::size_t picture_bytes(const scene::Camera& camera, bool has_layers, std::size_t light_layers);

// Throws files::UsageError if picture_bytes() is more than `available`.
void check_memory(const scene::Camera& camera, bool has_layers, std::size_t light_layers, std::size_t available);

// The memory of this machine, used or not.
std::size_t memory_of_machine();

}  // namespace likeness::render_command
