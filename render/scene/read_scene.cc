#include "render/scene/read_scene.h"

#include "render/files/files.h"
#include "render/image/read.h"
#include "render/scene/mesh_file.h"

namespace likeness::scene {

Scene read_scene(const std::filesystem::path& file) {
  const Access access{
      [](const std::filesystem::path& name, std::size_t limit) { return files::read_whole(name, limit); },
      [](const std::filesystem::path& name) { return image::read_texels(name); },
      [](std::string_view bytes, const std::string& name) { return image::decode_texels(bytes, name); },
      baked::from_files()};
  if (is_mesh_file(file)) return scene_of_mesh(file, access);
  constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  return scene_of(files::read_whole(file, kMostBytes), file.string(), file.parent_path(), access);
}

}  // namespace likeness::scene
