#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "render/json/json.h"
#include "render/scene/loading.h"

namespace likeness::scene {

// The JSON of a glTF 2.0 file and the bytes it points to. Everything asked of it is checked: an index, an offset or a
// count that does not hold throws files::InputError, one line that begins "file:line: /path".
class GltfDocument {
 public:
  // `bytes` (.glb: the container; .gltf: the JSON) must outlive it.
  GltfDocument(std::string_view bytes, const std::filesystem::path& file, Loading& loading);
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  struct Node {
    const json::Value* value = nullptr;  // null: it is not there
    std::string path;
    explicit operator bool() const { return value != nullptr; }
  };

  Node root() const { return {&root_, ""}; }
  Node member(const Node& node, std::string_view key) const;  // an object, or nothing
  std::vector<Node> list(const Node& node, std::string_view key) const;
  std::size_t count(std::string_view list) const;  // of a list of the root
  Node entry(std::string_view list, std::size_t index, const Node& user) const;
  // The same of a list of any object.
  Node item(const Node& node, std::string_view key, std::size_t index, const Node& user) const;
  // The entry of a list of the root that a number names.
  Node named(const Node& node, std::string_view key, std::string_view list) const;

  bool has(const Node& node, std::string_view key) const { return node && node.value->find(key); }
  double number(const Node& node, std::string_view key, double missing) const;
  std::size_t whole(const Node& node, std::string_view key, std::size_t missing) const;
  std::string text(const Node& node, std::string_view key) const;
  bool flag(const Node& node, std::string_view key) const;
  // `size` numbers; `missing` (as many) if there are none.
  std::vector<double> numbers(const Node& node, std::string_view key, std::vector<double> missing) const;

  template <class V>  // glm::vec2, vec3, vec4
  std::vector<V> vectors(std::size_t accessor, const Node& user) const;
  std::vector<Index> indices(std::size_t accessor, const Node& user) const;
  std::string_view buffer_view(std::size_t index, const Node& user) const;

  // Of a file beside this one, or of a data URI, which is put into `decoded`.
  std::filesystem::path file_of_uri(const std::string& uri, const Node& user) const;
  static bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }
  std::string data_of_uri(std::string_view uri, const Node& user) const;

  [[noreturn]] void refuse(const Node& node, const std::string& text) const;
  const std::string& source() const { return source_; }

 private:
  struct Elements {
    const char* data = nullptr;
    std::size_t count = 0, stride = 0, component_size = 0;
    int component = 0, channels = 0;
    bool is_normalized = false;
    Node node;
  };
  Elements elements(std::size_t accessor, const Node& user) const;
  static float component(const Elements& elements, std::size_t element, int channel);
  void split_container(std::string_view bytes, std::string_view& text);
  void read_buffers(Loading& loading);

  std::string source_;
  std::filesystem::path folder_;
  json::Value root_;
  bool has_binary_ = false;
  std::string_view binary_;         // of a .glb
  std::vector<std::string> owned_;  // bytes of other files
  std::vector<std::string_view> buffers_;
};

}  // namespace likeness::scene
