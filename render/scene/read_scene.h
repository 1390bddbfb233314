#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "render/scene/loading.h"
#include "render/scene/scene.h"

namespace likeness::scene {

// A scene from its file: scene.json (docs/scene.md), or a mesh file alone (.glb, .gltf, .obj, .ply), which is then all
// there is, with a glTF's cameras and lights. Whatever it names is read, checked and put right; what was put right is
// counted in `repairs`. A scene without a camera gets one that sees everything.
//
// Afterwards every index is inside its list; every number is finite; normals, tangents and directions are unit; areas,
// radii and determinants are not zero; a mesh whose material has a normal map has tangents, and one whose material has
// any texture has uvs (a sphere has its own, and is turned, moved and scaled, but not stretched).
//
// Throws files::InputError, one line: "scene.json:12: /lights/2/radius = -1 is outside ...".
Scene read_scene(const std::filesystem::path& file);

// The same from the text of a scene.json; `source` is for messages, `folder` is where the files that it names are.
Scene scene_of(std::string_view text, const std::string& source, const std::filesystem::path& folder,
               const Access& access);

// A scene of one mesh file.
Scene scene_of_mesh(const std::filesystem::path& file, const Access& access);

// Smallest and largest corner of everything that stands in the scene, in the world; low > high if there is nothing.
struct Bounds {
  glm::vec3 low{kFarthest}, high{-kFarthest};
  bool is_empty() const { return !(low.x <= high.x); }
};
Bounds bounds(const Scene& scene);

}  // namespace likeness::scene
