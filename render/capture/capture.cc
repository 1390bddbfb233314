#include "render/capture/capture.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace likeness::capture {
namespace {

template <class T>
std::size_t place_of(const std::vector<T>& list, std::string_view id) {
  const auto at = std::find_if(list.begin(), list.end(), [&](const T& one) { return one.id == id; });
  return at == list.end() ? kAbsent : static_cast<std::size_t>(at - list.begin());
}

}  // namespace

bool is_id(std::string_view text) {
  return !text.empty() && text.size() <= 120 && text != "." && text != ".." &&
         std::none_of(text.begin(), text.end(), [](char c) {
           return c == '/' || c == '\\' || static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
         });
}

std::size_t camera_of(const Capture& capture, std::string_view id) { return place_of(capture.cameras, id); }
std::size_t light_of(const Capture& capture, std::string_view id) { return place_of(capture.lights, id); }
std::size_t variant_of(const Capture& capture, std::string_view id) { return place_of(capture.variants, id); }

std::size_t rendered_variant_of(const Capture& capture) {
  for (std::size_t at = 0; at < capture.variants.size(); ++at)
    for (const Frame& frame : capture.frames) {
      std::error_code ignored;
      if (frame.kind == FrameKind::kOneLight &&
          std::filesystem::exists(render_file(capture, capture.variants[at], frame.camera, frame.light), ignored))
        return at;
    }
  return capture.variants.empty() ? kAbsent : 0;
}

FrameTable::FrameTable(const Capture& capture)
    : lights_(capture.lights.size()),
      frames_(capture.cameras.size() * capture.lights.size(), kAbsent),
      crossed_(frames_) {
  for (std::size_t i = 0; i < capture.frames.size(); ++i) {
    const Frame& frame = capture.frames[i];
    if (!is_of_one_light(frame.kind)) continue;
    std::size_t& at = (frame.kind == FrameKind::kCrossed ? crossed_ : frames_)[frame.camera * lights_ + frame.light];
    if (at == kAbsent) at = i;
  }
}

std::size_t FrameTable::frame(std::size_t camera, std::size_t light) const {
  const std::size_t at = camera * lights_ + light;
  return light < lights_ && at < frames_.size() ? frames_[at] : kAbsent;
}

std::size_t FrameTable::crossed(std::size_t camera, std::size_t light) const {
  const std::size_t at = camera * lights_ + light;
  return light < lights_ && at < crossed_.size() ? crossed_[at] : kAbsent;
}

std::string filled(std::string_view pattern, std::string_view camera, std::string_view light,
                   std::string_view variant) {
  struct Word {
    std::string_view name, text;
  };
  const Word words[] = {{"{camera}", camera}, {"{light}", light}, {"{variant}", variant}};
  std::string out;
  for (std::size_t i = 0; i < pattern.size();) {
    const Word* found = nullptr;
    for (const Word& word : words)
      if (pattern.substr(i).starts_with(word.name)) found = &word;
    if (found) out += found->text;
    else out += pattern[i];
    i += found ? found->name.size() : 1;
  }
  return out;
}

std::filesystem::path render_file(const Capture& capture, const Variant& variant, std::size_t camera,
                                  std::size_t light) {
  return capture.root / filled(variant.pattern, capture.cameras[camera].id, capture.lights[light].id, variant.id);
}

std::filesystem::path photo_file(const Capture& capture, const Frame& frame) { return capture.root / frame.file; }

std::filesystem::path layer_file(const Capture& capture, std::size_t camera, Layer layer) {
  for (const LayerFile& one : capture.layers)
    if (one.camera == camera && one.layer == layer) return capture.root / one.file;
  return {};
}

}  // namespace likeness::capture
