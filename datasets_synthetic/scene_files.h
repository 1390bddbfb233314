#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "render/scene/scene.h"

namespace likeness::datasets_synthetic {

using SceneJson = nlohmann::ordered_json;

// A scene that is being made: its document, with meshes and textures written to files beside it as they come.
class SceneFiles {
 public:
  SceneFiles(std::filesystem::path folder, const std::string& kind);

  // A mesh of its own, as meshes/NAME.ply. Vertices that no triangle uses are left out.
  void add_mesh(const std::string& name, scene::Mesh mesh);
  // A mesh that the reader of scenes makes (docs/scene.md): sphere, plane, box, ...
  void add_shape(const std::string& name, const SceneJson& shape);

  // textures/NAME.exr of halves; `texel` gives the channels (1: grey, 3: linear red, green and blue) at the middle
  // (u, v) of each texel, v downwards. Returns the entry for a material.
  using Texel = std::function<void(double u, double v, float* channels)>;
  SceneJson add_texture(const std::string& name, int width, int height, int channels, const Texel& texel);

  void add_material(const std::string& name, const SceneJson& material);
  void add_instance(const std::string& mesh, const std::string& material, const SceneJson& placement = {});
  void add_light(const SceneJson& light) { document_["lights"].push_back(light); }
  void add_camera(const SceneJson& camera) { document_["cameras"].push_back(camera); }
  void set_environment(const SceneJson& environment) { document_["environment"] = environment; }
  void set_view(const SceneJson& view) { document_["view"] = view; }
  SceneJson& lights() { return document_["lights"]; }

  // The scene file itself, once all it names is there.
  void write(const std::string& file = "scene.json");

  std::size_t meshes() const { return meshes_; }
  std::size_t textures() const { return textures_; }
  const std::vector<std::filesystem::path>& scenes() const { return scenes_; }

 private:
  std::filesystem::path folder_;
  SceneJson document_;
  std::size_t meshes_ = 0, textures_ = 0;
  std::vector<std::filesystem::path> scenes_;
};

// JSON of which what fits on a line is on a line.
std::string pretty(const SceneJson& value);

// Begins the comment of every scene that is made, by which a later run knows that it may be replaced.
inline constexpr const char* kMadeBy = "made by likeness make scene";

}  // namespace likeness::datasets_synthetic
