#include "render/scene/loading.h"

#include <cmath>

#include "render/files/files.h"
#include "render/json/json.h"
#include "render/scene/ies.h"

namespace likeness::scene {
namespace {

constexpr float kLargestHalf = 65504;  // what infinity becomes: the largest that an EXR of halves holds
constexpr float kBrightest = 1e12f;

struct Mended {
  std::size_t not_numbers = 0, infinite = 0;
};

Mended mend(std::vector<float>& texels) {
  Mended count;
  for (float& x : texels) {
    if (std::abs(x) <= kBrightest) continue;
    if (std::isnan(x)) {
      x = 0;
      ++count.not_numbers;
    } else {
      x = std::copysign(std::isinf(x) ? kLargestHalf : kBrightest, x);
      ++count.infinite;
    }
  }
  return count;
}

std::size_t lift_negative(std::vector<float>& texels) {
  std::size_t count = 0;
  for (float& x : texels)
    if (x < 0) {
      x = 0;
      ++count;
    }
  return count;
}

// A file may name another by anything: what is no name must not become a part of one, or of a message.
void check_name(const std::filesystem::path& file) {
  const std::string name = file.string();
  for (const char c : name)
    if (static_cast<unsigned char>(c) < 0x20)
      throw files::InputError(json::plain(name) + ": has a control character in its name; expected the name of a file");
}

}  // namespace

template <class Read>
Index Loading::once(const std::string& key, bool is_light, Read&& read) {
  auto [at, fresh] = images_.try_emplace(key, kNone);
  if (fresh) {
    Image image{key, read()};
    const image::Texels& t = image.texels;
    if (t.width < 1 || t.height < 1 || t.channels < 1 || t.channels > 4 ||
        t.count() * static_cast<std::size_t>(t.channels) != t.bytes.size() + t.floats.size())
      throw files::InputError(key + ": holds no picture");
    count_bytes(t.bytes.size() + 4 * t.floats.size(), key);
    const Mended mended = mend(image.texels.floats);
    if (mended.not_numbers) repair("texels that are no numbers made 0", key, mended.not_numbers);
    if (mended.infinite) repair("texels without bound made finite", key, mended.infinite);
    at->second = static_cast<Index>(scene_.images.size());
    scene_.images.push_back(std::move(image));
  }
  if (is_light)
    if (const std::size_t count = lift_negative(scene_.images[at->second].texels.floats))
      repair("negative texels of light made 0", key, count);
  return at->second;
}

void Loading::count_bytes(std::size_t bytes, const std::string& key) {
  texel_bytes_ += bytes;
  if (texel_bytes_ > kMostTexelBytes)
    throw files::InputError(key +
                            ": with it the pictures of the scene take more than 16 GB of memory; use smaller ones");
}

std::string Loading::bytes(const std::filesystem::path& file, std::size_t limit) {
  check_name(file);
  return access_.bytes(file, limit);
}

Index Loading::image(const std::filesystem::path& file, bool is_light) {
  check_name(file);
  return once(file.lexically_normal().string(), is_light, [&] { return access_.texels(file); });
}

Index Loading::image(std::string_view encoded, const std::string& name, bool is_light) {
  return once(name, is_light, [&] { return access_.decode(encoded, name); });
}

Index Loading::profile(const std::filesystem::path& file) {
  const std::string key = file.lexically_normal().string();
  auto [at, fresh] = profiles_.try_emplace(key, kNone);
  if (fresh) {
    scene_.profiles.push_back(profile_of(bytes(file, kMostProfileBytes), key));
    at->second = static_cast<Index>(scene_.profiles.size() - 1);
  }
  return at->second;
}

Index Loading::bake(const std::filesystem::path& folder) {
  check_name(folder);
  const std::string key = folder.lexically_normal().string();
  auto [at, fresh] = bakes_.try_emplace(key, kNone);
  if (fresh) {
    if (!access_.bakes.bytes) throw files::InputError(key + ": is a bake, which cannot be read from here");
    baked::Residual bake = baked::read_residual(folder, access_.bakes);
    count_bytes(bake.bytes(), key);
    at->second = static_cast<Index>(scene_.bakes.size());
    scene_.bakes.push_back(std::move(bake));
  }
  return at->second;
}

void Loading::repair(const std::string& what, const std::string& where, std::size_t count) {
  const auto [at, fresh] = repairs_.try_emplace({what, where}, scene_.repairs.size());
  if (fresh) scene_.repairs.push_back({what, where, 0});
  scene_.repairs[at->second].count += count;
}

}  // namespace likeness::scene
