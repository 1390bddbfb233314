#include "olat/tev/images.h"

#include <algorithm>
#include <string_view>

#include "render/files/files.h"

namespace likeness::olat_tev {
namespace {

constexpr std::uint8_t kAll = 3, kNone = 4;

bool is_channel(std::string_view name, char letter) {
  return !name.empty() && name.back() == letter && (name.size() == 1 || name[name.size() - 2] == '.');
}

std::vector<std::uint8_t> targets_of(const std::vector<std::string>& channels) {
  std::vector<std::uint8_t> out(channels.size(), kNone);
  bool has_color = false;
  for (const char letter : {'R', 'G', 'B'})
    for (std::size_t c = 0; c < channels.size(); ++c)
      if (is_channel(channels[c], letter)) {
        out[c] = static_cast<std::uint8_t>(std::string_view("RGB").find(letter));
        has_color = true;
        break;  // the first layer of many
      }
  if (!has_color) out[0] = kAll;
  return out;
}

}  // namespace

void Images::take(const Packet& packet) {
  const std::lock_guard lock(mutex_);
  if (const auto* one = std::get_if<Create>(&packet)) create(*one);
  if (const auto* one = std::get_if<Update>(&packet)) update(*one);
  if (const auto* one = std::get_if<Close>(&packet))
    if (const auto at = images_.find(one->name); at != images_.end()) {
      bytes_ -= at->second.rgb.size() * sizeof(float);
      images_.erase(at);
    }
}

void Images::create(const Create& create) {
  const std::size_t values = 3 * static_cast<std::size_t>(create.width) * static_cast<std::size_t>(create.height);
  if (values * sizeof(float) > most_bytes_)
    throw files::InputError("tev: " + std::to_string(create.width) + " x " + std::to_string(create.height) +
                            " pixels are more than the " + std::to_string(most_bytes_ >> 20) + " MB that are kept");
  const auto drop = [&](std::map<std::string, Image>::iterator at) {
    bytes_ -= at->second.rgb.size() * sizeof(float);
    images_.erase(at);
  };
  if (const auto at = images_.find(create.name); at != images_.end()) drop(at);
  while (!images_.empty() && (bytes_ + values * sizeof(float) > most_bytes_ || images_.size() >= kMostImages))
    drop(std::min_element(images_.begin(), images_.end(),
                          [](const auto& a, const auto& b) { return a.second.version < b.second.version; }));
  Image image{create.width,   create.height, create.channels, targets_of(create.channels), std::vector<float>(values),
              ++last_version_};
  bytes_ += values * sizeof(float);
  images_.emplace(create.name, std::move(image));
}

void Images::update(const Update& update) {
  const auto at = images_.find(update.name);
  if (at == images_.end()) return;
  Image& image = at->second;
  if (update.x + update.width > image.width || update.y + update.height > image.height) return;
  image.version = ++last_version_;
  for (std::size_t c = 0; c < update.channels.size(); ++c) {
    const auto named = std::find(image.channels.begin(), image.channels.end(), update.channels[c]);
    if (named == image.channels.end()) continue;
    const std::uint8_t target = image.target[static_cast<std::size_t>(named - image.channels.begin())];
    if (target == kNone) continue;
    auto from = static_cast<std::size_t>(update.offsets[c]);
    for (int y = update.y; y < update.y + update.height; ++y)
      for (int x = update.x; x < update.x + update.width; ++x, from += static_cast<std::size_t>(update.strides[c])) {
        float* const to = &image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                          static_cast<std::size_t>(x))];
        if (target == kAll) to[0] = to[1] = to[2] = update.values[from];
        else to[target] = update.values[from];
      }
  }
}

std::vector<Images::Known> Images::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<Known> out;
  for (const auto& [name, image] : images_) out.push_back({name, image.version});
  return out;
}

std::optional<std::uint64_t> Images::version(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto at = images_.find(name);
  if (at == images_.end()) return std::nullopt;
  return at->second.version;
}

std::optional<image::Picture> Images::picture(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto at = images_.find(name);
  if (at == images_.end()) return std::nullopt;
  image::Picture out;
  out.width = at->second.width;
  out.height = at->second.height;
  out.rgb = at->second.rgb;
  return out;
}

std::size_t Images::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace likeness::olat_tev
