#include "render/baked/bake_file.h"
#include "render/files/files.h"
#include "render/image/read.h"

namespace likeness::baked {

Access from_files() {
  return {[](const std::filesystem::path& file, std::size_t limit) { return files::read_whole(file, limit); },
          [](const std::filesystem::path& file, std::size_t most) {
            return image::read_texels(file, {.layer = {}, .most_texels = most});
          },
          [](const std::filesystem::path& file, std::size_t most) { return image::read_layers(file, most); },
          [](const std::filesystem::path& file) { return std::filesystem::exists(file); }};
}

}  // namespace likeness::baked
