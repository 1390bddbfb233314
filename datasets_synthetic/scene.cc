#include "datasets_synthetic/scene.h"

#include "datasets_synthetic/scene_files.h"

namespace likeness::datasets_synthetic {

std::vector<std::filesystem::path> write_scene(const SceneKind& kind, const SceneOptions& options) {
  SceneOptions complete = options;
  if (complete.width == 0) complete.width = kind.width;
  if (complete.height == 0) complete.height = kind.height;
  SceneFiles files(options.folder, std::string(kind.name));
  kind.make(complete, files);
  if (files.scenes().empty()) files.write();
  return files.scenes();
}

}  // namespace likeness::datasets_synthetic
