#pragma once

#include <string_view>

#include "render/scene/gltf_document.h"

namespace likeness::scene {

// A glTF material as Callisto (docs/scene.md, "glTF"). Its pictures are read into the scene, each once.
Material gltf_material(const GltfDocument& document, const GltfDocument::Node& material, Loading& loading);

}  // namespace likeness::scene
