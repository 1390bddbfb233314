#include <algorithm>
#include <stdexcept>
#include <string>

#include "render/files/files.h"
#include "render/scene/ies.h"
#include "render/scene/mesh_file.h"
#include "render/scene/read_scene.h"
#include "tests/fuzz/feed.h"
#include "tests/render/scene/small_files.h"
#include "tests/render/scene/sound.h"

namespace likeness::measured::test {

bool feed_scene(std::string_view format, std::string_view bytes) {
  const auto hold = [](bool promise, const std::string& text) {
    if (!promise) throw std::logic_error(text);
  };
  static const scene::test::Files kFiles = scene::test::small_files();
  try {
    scene::Scene out;
    if (format == "ies") {
      const scene::Profile profile = scene::profile_of(bytes, "fuzz");
      const double angle = scene::solid_angle(profile);
      hold(angle >= -1e-6 && angle < 4 * 3.1416, "a profile over its peak is at most the whole sphere");
      return true;
    }
    if (format == "scene") {
      out = scene::scene_of(bytes, "fuzz", "", scene::test::access_of(kFiles));
    } else {
      const scene::test::Files files{{"fuzz." + std::string(format), std::string(bytes)},
                                     {"paint.mtl", kFiles.at("paint.mtl")}};
      out = scene::scene_of_mesh("fuzz." + std::string(format), scene::test::access_of(files));
    }
    const std::string fault = scene::test::fault_of(out);
    hold(fault.empty(), fault);
  } catch (const files::InputError& error) {
    const std::string_view message = error.what();
    hold(message.find('\n') == message.npos, "a message is one line");
    hold(message.find(": ") != message.npos, "a message names the place");
    return false;
  }
  return true;
}

}  // namespace likeness::measured::test
