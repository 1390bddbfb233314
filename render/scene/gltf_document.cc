#include "render/scene/gltf_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "render/files/files.h"

namespace likeness::scene {
namespace {

using files::in_quotes;
using files::number_text;

// Component types of accessors (glTF 2.0, 3.6.2.2).
enum Component { kByte = 5120, kUbyte = 5121, kShort = 5122, kUshort = 5123, kUint = 5125, kFloat = 5126 };

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t out;
  std::memcpy(&out, bytes.data() + at, sizeof out);
  return out;
}

template <class T>
T load(const char* at) {
  T out;
  std::memcpy(&out, at, sizeof out);
  return out;
}

}  // namespace

GltfDocument::GltfDocument(std::string_view bytes, const std::filesystem::path& file, Loading& loading)
    : source_(file.string()), folder_(file.parent_path()) {
  std::string_view text = bytes;
  if (bytes.starts_with("glTF")) split_container(bytes, text);
  root_ = json::parse(text, source_, {.values = 4'000'000, .depth = 64});
  if (!root_.is_object()) refuse(root(), " is " + json::kind_text(root_) + "; expected an object");
  // The root is asked by name for each node of a file; a real one has some twenty members.
  if (root_.items.size() > 256)
    refuse(root(), " has " + std::to_string(root_.items.size()) + " members; expected a glTF 2.0 file");
  const Node asset = member(root(), "asset");
  if (!asset) refuse(root(), "/asset is missing; expected a glTF 2.0 file");
  const std::string version = this->text(asset, "version");
  if (!version.starts_with("2.")) refuse(asset, "/version = " + in_quotes(version) + "; this program reads 2.0");
  constexpr std::array<std::string_view, 7> kKnown{
      "KHR_texture_transform", "KHR_lights_punctual",    "KHR_mesh_quantization", "KHR_materials_emissive_strength",
      "KHR_materials_ior",     "KHR_materials_specular", "KHR_materials_unlit"};
  for (const Node& name : list(root(), "extensionsRequired"))
    if (std::find(kKnown.begin(), kKnown.end(), name.value->text) == kKnown.end())
      refuse(name, " = " + in_quotes(name.value->text) + " is not read by this program; export without it");
  read_buffers(loading);
}

void GltfDocument::split_container(std::string_view bytes, std::string_view& text) {
  const auto wrong = [&](const std::string& what) {
    throw files::InputError(source_ + ": " + what + "; expected a glTF 2.0 container");
  };
  if (bytes.size() < 20) wrong("ends within its header");
  if (word_at(bytes, 4) != 2) wrong("is version " + std::to_string(word_at(bytes, 4)) + " of the container");
  if (word_at(bytes, 8) > bytes.size())
    wrong("ends after " + std::to_string(bytes.size()) + " of its " + std::to_string(word_at(bytes, 8)) + " bytes");
  bytes = bytes.substr(0, std::max<std::size_t>(word_at(bytes, 8), 20));
  bool has_text = false;
  for (std::size_t at = 12; at + 8 <= bytes.size();) {
    const std::size_t size = word_at(bytes, at);
    const std::string_view kind = bytes.substr(at + 4, 4);
    if (size > bytes.size() - at - 8) wrong("has a chunk of " + std::to_string(size) + " bytes, more than it holds");
    const std::string_view chunk = bytes.substr(at + 8, size);
    if (kind == "JSON" && !has_text) {
      text = chunk;
      has_text = true;
    } else if (kind == std::string_view("BIN\0", 4) && !has_binary_) {
      binary_ = chunk;
      has_binary_ = true;
    }
    at += 8 + size;
  }
  if (!has_text) wrong("has no JSON chunk");
}

void GltfDocument::read_buffers(Loading& loading) {
  const std::vector<Node> all = list(root(), "buffers");
  owned_.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Node& buffer = all[i];
    const std::size_t size = whole(buffer, "byteLength", 0);
    std::string_view bytes;
    if (has(buffer, "uri")) {
      const std::string uri = text(buffer, "uri");
      owned_[i] =
          is_data_uri(uri) ? data_of_uri(uri, buffer) : loading.bytes(file_of_uri(uri, buffer), kMostMeshFileBytes);
      bytes = owned_[i];
    } else if (i == 0 && has_binary_) {
      bytes = binary_;
    } else {
      refuse(buffer, " has no uri, and there is no binary chunk");
    }
    if (size > bytes.size())
      refuse(buffer, "/byteLength = " + std::to_string(size) + "; its file holds " + std::to_string(bytes.size()));
    buffers_.push_back(bytes.substr(0, size));
  }
}

void GltfDocument::refuse(const Node& node, const std::string& text) const {
  throw files::InputError(source_ + ":" + std::to_string(node.value ? node.value->line : 1) + ": " +
                          (node.path.empty() && text.starts_with(" ") ? "the file" : node.path) + text);
}

GltfDocument::Node GltfDocument::member(const Node& node, std::string_view key) const {
  const json::Value* value = node ? node.value->find(key) : nullptr;
  if (!value) return {nullptr, node.path + "/" + std::string(key)};
  Node out{value, node.path + "/" + std::string(key)};
  if (!value->is_object()) refuse(out, " is " + json::kind_text(*value) + "; expected an object");
  return out;
}

std::vector<GltfDocument::Node> GltfDocument::list(const Node& node, std::string_view key) const {
  std::vector<Node> out;
  const json::Value* value = node ? node.value->find(key) : nullptr;
  if (!value) return out;
  const Node all{value, node.path + "/" + std::string(key)};
  if (!value->is_list()) refuse(all, " is " + json::kind_text(*value) + "; expected a list");
  out.reserve(value->items.size());
  for (std::size_t i = 0; i < value->items.size(); ++i)
    out.push_back({&value->items[i], all.path + "/" + std::to_string(i)});
  return out;
}

std::size_t GltfDocument::count(std::string_view list) const {
  const json::Value* value = root_.find(list);
  return value && value->is_list() ? value->items.size() : 0;
}

GltfDocument::Node GltfDocument::item(const Node& node, std::string_view key, std::size_t index,
                                      const Node& user) const {
  const json::Value* list = node ? node.value->find(key) : nullptr;
  const std::size_t count = list && list->is_list() ? list->items.size() : 0;
  const std::string path = node.path + "/" + std::string(key) + "/" + std::to_string(index);
  if (index >= count) refuse(user, " names " + path + ", but there are " + std::to_string(count));
  const Node out{&list->items[index], path};
  if (!out.value->is_object()) refuse(out, " is " + json::kind_text(*out.value) + "; expected an object");
  return out;
}

GltfDocument::Node GltfDocument::entry(std::string_view list, std::size_t index, const Node& user) const {
  return item(root(), list, index, user);
}

GltfDocument::Node GltfDocument::named(const Node& node, std::string_view key, std::string_view list) const {
  return entry(list, whole(node, key, 0), Node{node.value->find(key), node.path + "/" + std::string(key)});
}

double GltfDocument::number(const Node& node, std::string_view key, double missing) const {
  const json::Value* value = node ? node.value->find(key) : nullptr;
  if (!value) return missing;
  if (!value->is_number())
    refuse({value, node.path + "/" + std::string(key)}, " is " + json::kind_text(*value) + "; expected a number");
  return value->number;
}

std::size_t GltfDocument::whole(const Node& node, std::string_view key, std::size_t missing) const {
  const json::Value* value = node ? node.value->find(key) : nullptr;
  if (!value) return missing;
  if (!value->is_number() || !(value->number >= 0 && value->number <= 9e15) ||
      value->number != std::floor(value->number))
    refuse({value, node.path + "/" + std::string(key)},
           " is " + json::kind_text(*value) + "; expected a whole number that is not negative");
  return static_cast<std::size_t>(value->number);
}

std::string GltfDocument::text(const Node& node, std::string_view key) const {
  const json::Value* value = node ? node.value->find(key) : nullptr;
  if (!value) return "";
  if (!value->is_text())
    refuse({value, node.path + "/" + std::string(key)}, " is " + json::kind_text(*value) + "; expected a text");
  return value->text;
}

bool GltfDocument::flag(const Node& node, std::string_view key) const {
  const json::Value* value = node ? node.value->find(key) : nullptr;
  return value && value->kind == json::Kind::kFlag && value->number != 0;
}

std::vector<double> GltfDocument::numbers(const Node& node, std::string_view key, std::vector<double> missing) const {
  if (!has(node, key)) return missing;
  std::vector<double> out;
  for (const Node& item : list(node, key)) {
    if (!item.value->is_number()) refuse(item, " is " + json::kind_text(*item.value) + "; expected a number");
    if (!(std::abs(item.value->number) <= 1e30))
      refuse(item, " = " + number_text(item.value->number) + " is too large");
    out.push_back(item.value->number);
  }
  if (out.size() != missing.size())
    refuse({node.value->find(key), node.path + "/" + std::string(key)},
           " has " + std::to_string(out.size()) + " numbers; expected " + std::to_string(missing.size()));
  return out;
}

std::string_view GltfDocument::buffer_view(std::size_t index, const Node& user) const {
  const Node view = entry("bufferViews", index, user);
  const std::size_t buffer = whole(view, "buffer", 0), offset = whole(view, "byteOffset", 0),
                    size = whole(view, "byteLength", 0);
  if (buffer >= buffers_.size())
    refuse(view, "/buffer = " + std::to_string(buffer) + ", but there are " + std::to_string(buffers_.size()));
  if (offset > buffers_[buffer].size() || size > buffers_[buffer].size() - offset)
    refuse(view, " spans bytes " + std::to_string(offset) + " to " + std::to_string(offset + size) +
                     " of a buffer of " + std::to_string(buffers_[buffer].size()));
  return buffers_[buffer].substr(offset, size);
}

GltfDocument::Elements GltfDocument::elements(std::size_t accessor, const Node& user) const {
  Elements out;
  out.node = entry("accessors", accessor, user);
  if (has(out.node, "sparse")) refuse(out.node, "/sparse: sparse accessors are not read; export without them");
  if (!has(out.node, "bufferView")) refuse(out.node, "/bufferView is missing: there are no values");
  constexpr std::array<std::string_view, 4> kTypes{"SCALAR", "VEC2", "VEC3", "VEC4"};
  const std::string type = text(out.node, "type");
  const auto found = std::find(kTypes.begin(), kTypes.end(), type);
  if (found == kTypes.end()) refuse(out.node, "/type = " + in_quotes(type) + "; expected SCALAR, VEC2, VEC3 or VEC4");
  out.channels = 1 + static_cast<int>(found - kTypes.begin());
  const std::size_t component = whole(out.node, "componentType", 0);
  switch (component) {
    case kByte:
    case kUbyte:
      out.component_size = 1;
      break;
    case kShort:
    case kUshort:
      out.component_size = 2;
      break;
    case kUint:
    case kFloat:
      out.component_size = 4;
      break;
    default:
      refuse(out.node, "/componentType = " + std::to_string(component) + " is none of glTF 2.0");
  }
  out.component = static_cast<int>(component);
  out.is_normalized = flag(out.node, "normalized");
  out.count = whole(out.node, "count", 0);
  const std::size_t size = out.component_size * static_cast<std::size_t>(out.channels);
  const std::size_t view_index = whole(out.node, "bufferView", 0);
  const std::string_view view = buffer_view(view_index, out.node);
  const Node view_node = entry("bufferViews", view_index, out.node);
  const std::size_t stride = whole(view_node, "byteStride", 0);
  if (stride != 0 && (stride < size || stride > 252))
    refuse(view_node, "/byteStride = " + std::to_string(stride) + "; expected " + std::to_string(size) + " to 252");
  out.stride = stride ? stride : size;
  const std::size_t offset = whole(out.node, "byteOffset", 0);
  if (out.count == 0) return out;
  if (offset > view.size() || size > view.size() - offset || out.count - 1 > (view.size() - offset - size) / out.stride)
    refuse(out.node, " has " + std::to_string(out.count) + " elements of " + std::to_string(out.stride) +
                         " bytes from byte " + std::to_string(offset) + ", but its view has " +
                         std::to_string(view.size()) + " bytes");
  if (out.count >= kNone) refuse(out.node, "/count = " + std::to_string(out.count) + "; expected below 2^32");
  out.data = view.data() + offset;
  return out;
}

float GltfDocument::component(const Elements& e, std::size_t element, int channel) {
  const char* at = e.data + element * e.stride + static_cast<std::size_t>(channel) * e.component_size;
  const auto whole = [&](auto value, float largest) {
    return e.is_normalized ? std::max(static_cast<float>(value) / largest, -1.0f) : static_cast<float>(value);
  };
  switch (e.component) {
    case kByte:
      return whole(load<std::int8_t>(at), 127);
    case kUbyte:
      return whole(load<std::uint8_t>(at), 255);
    case kShort:
      return whole(load<std::int16_t>(at), 32767);
    case kUshort:
      return whole(load<std::uint16_t>(at), 65535);
    case kUint:
      return whole(load<std::uint32_t>(at), 4294967295.0f);
    default:
      return load<float>(at);
  }
}

template <class V>
std::vector<V> GltfDocument::vectors(std::size_t accessor, const Node& user) const {
  const Elements e = elements(accessor, user);
  if (e.channels != V::length())
    refuse(e.node, "/type = " + in_quotes(text(e.node, "type")) + "; expected VEC" + std::to_string(V::length()));
  std::vector<V> out(e.count);
  if (e.component == kFloat && e.stride == sizeof(V) && e.count > 0) {
    std::memcpy(out.data(), e.data, e.count * sizeof(V));
    return out;
  }
  for (std::size_t i = 0; i < e.count; ++i)
    for (int c = 0; c < V::length(); ++c) out[i][c] = component(e, i, c);
  return out;
}
template std::vector<glm::vec2> GltfDocument::vectors(std::size_t, const Node&) const;
template std::vector<glm::vec3> GltfDocument::vectors(std::size_t, const Node&) const;
template std::vector<glm::vec4> GltfDocument::vectors(std::size_t, const Node&) const;

std::vector<Index> GltfDocument::indices(std::size_t accessor, const Node& user) const {
  const Elements e = elements(accessor, user);
  if (e.channels != 1 || (e.component != kUbyte && e.component != kUshort && e.component != kUint))
    refuse(e.node, " gives indices; expected SCALAR of unsigned integers");
  std::vector<Index> out(e.count);
  for (std::size_t i = 0; i < e.count; ++i) {
    const char* at = e.data + i * e.stride;
    out[i] = e.component == kUint     ? load<std::uint32_t>(at)
             : e.component == kUshort ? load<std::uint16_t>(at)
                                      : load<std::uint8_t>(at);
  }
  return out;
}

std::filesystem::path GltfDocument::file_of_uri(const std::string& uri, const Node& user) const {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto digit = [&](std::size_t at) {
      const char c = at < uri.size() ? uri[at] : 'x';
      return c >= '0' && c <= '9'   ? c - '0'
             : c >= 'a' && c <= 'f' ? c - 'a' + 10
             : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                    : -1;
    };
    if (uri[i] == '%' && digit(i + 1) >= 0 && digit(i + 2) >= 0) {
      name += static_cast<char>(16 * digit(i + 1) + digit(i + 2));
      i += 2;
    } else {
      name += uri[i];
    }
  }
  if (name.find("://") != std::string::npos || name.starts_with("/") || name.find('\0') != std::string::npos)
    refuse(user, "/uri = " + in_quotes(uri) + "; expected the name of a file beside this one");
  return folder_ / name;
}

std::string GltfDocument::data_of_uri(std::string_view uri, const Node& user) const {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
    refuse(user, "/uri is data, but not base64");
  std::string out;
  out.reserve(uri.size() * 3 / 4);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : uri.substr(comma + 1)) {
    const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+'             ? 62
                      : c == '/'             ? 63
                                             : -1;
    if (c == '=') break;
    if (value < 0)
      refuse(user, "/uri has the character " + in_quotes(std::string_view(&c, 1)) + ", which is not base64");
    bits = (bits << 6 | static_cast<std::uint32_t>(value)) & 0xffffff;
    if (++count % 4 == 0)
      for (const int shift : {16, 8, 0}) out += static_cast<char>(bits >> shift & 0xff);
  }
  if (count % 4 == 2) out += static_cast<char>(bits >> 4 & 0xff);
  if (count % 4 == 3)
    for (const int shift : {10, 2}) out += static_cast<char>(bits >> shift & 0xff);
  return out;
}

}  // namespace likeness::scene
