#pragma once

#include <string>
#include <string_view>

#include "render/scene/read_scene.h"
#include "tests/render/scene/small_files.h"

namespace likeness::scene::test {

// A scene file of these members, with its two lines of format first; what follows begins in line 2.
inline std::string scene_with(const std::string& members) {
  return "{\"format\": \"likeness scene\", \"version\": 1,\n" + members + "}";
}

inline Scene scene_of_text(const std::string& text, const Files& files = small_files()) {
  return scene_of(text, "room.json", "", access_of(files));
}
inline Scene scene_of_members(const std::string& members) { return scene_of_text(scene_with(members)); }

// What the reader says of a text; empty if it takes it. One line, always.
inline std::string refusal_of_text(const std::string& text, const Files& files = small_files()) {
  try {
    scene_of_text(text, files);
  } catch (const likeness::files::InputError& error) {
    const std::string what = error.what();
    return what.find('\n') == std::string::npos ? what : "MORE THAN ONE LINE: " + what;
  }
  return "";
}
inline std::string refusal(const std::string& members) { return refusal_of_text(scene_with(members)); }

inline Scene scene_of_file(const std::string& name, const std::string& bytes) {
  Files files = small_files();
  files[name] = bytes;
  return scene_of_mesh(name, access_of(files));
}
inline std::string refusal_of_file(const std::string& name, const std::string& bytes) {
  try {
    scene_of_file(name, bytes);
  } catch (const likeness::files::InputError& error) {
    return error.what();
  }
  return "";
}

inline std::size_t count_of(const Scene& scene, std::string_view repair) {
  std::size_t count = 0;
  for (const Repair& one : scene.repairs)
    if (one.what.find(repair) != std::string::npos) count += one.count;
  return count;
}

}  // namespace likeness::scene::test
