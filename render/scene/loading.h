#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "render/scene/scene.h"

namespace likeness::scene {

// Where a reader's bytes come from: files, or for tests and fuzzers a table in memory. What they throw goes through.
struct Access {
  std::function<std::string(const std::filesystem::path& file, std::size_t limit)> bytes;
  std::function<image::Texels(const std::filesystem::path& file)> texels;
  std::function<image::Texels(std::string_view bytes, const std::string& name)> decode;
  baked::Access bakes{};  // of the folders of bakes; without it there are none
};

inline constexpr std::size_t kMostMeshFileBytes = std::size_t{4} << 30;
inline constexpr std::size_t kMostTexelBytes = std::size_t{16} << 30;  // of all pictures of a scene
inline constexpr std::size_t kMostMeshBytes = std::size_t{8} << 30;    // of all meshes of a file
inline constexpr std::size_t kMostParts = 1'000'000;                   // meshes of a file in their places
inline constexpr std::size_t kMostPixels = std::size_t{1} << 28;       // of a camera
inline constexpr float kFarthest = 1e9f;  // [m]: of a coordinate, so that its square's square is still a float

// A scene while its files are read: each picture and each profile once, and a count of what had to be put right.
class Loading {
 public:
  Loading(Scene& scene, const Access& access) : scene_(scene), access_(access) {}

  Scene& scene() { return scene_; }
  std::string bytes(const std::filesystem::path& file, std::size_t limit);

  // The picture's index in the scene. Texels that are no numbers become 0, those beyond any light the largest; where
  // the picture is light, negative ones become 0 too.
  Index image(const std::filesystem::path& file, bool is_light);
  Index image(std::string_view encoded, const std::string& name, bool is_light);
  Index profile(const std::filesystem::path& file);
  Index bake(const std::filesystem::path& folder);

  // Adds to the count of the same thing at the same place.
  void repair(const std::string& what, const std::string& where, std::size_t count = 1);

 private:
  template <class Read>
  Index once(const std::string& key, bool is_light, Read&& read);
  void count_bytes(std::size_t bytes, const std::string& key);

  Scene& scene_;
  const Access& access_;
  std::map<std::string, Index> images_, profiles_, bakes_;
  std::map<std::pair<std::string, std::string>, std::size_t> repairs_;
  std::size_t texel_bytes_ = 0;
};

}  // namespace likeness::scene
