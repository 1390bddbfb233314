#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "render/files/files.h"
#include "render/scene/mesh_file.h"
#include "render/scene/words.h"

// Stanford PLY 1.0: ascii, binary_little_endian, binary_big_endian. Of the element `vertex`: x y z, nx ny nz, and the
// texture coordinates under any of the names in use; of the element `face`: the list of its corners, as a fan of
// triangles. Everything else is read over.
namespace likeness::scene {
namespace {

using files::in_quotes;

enum class Number { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };
constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};

std::optional<Number> number_of_name(std::string_view name) {
  constexpr std::array<std::array<std::string_view, 2>, 8> kNames{{{"char", "int8"},
                                                                   {"uchar", "uint8"},
                                                                   {"short", "int16"},
                                                                   {"ushort", "uint16"},
                                                                   {"int", "int32"},
                                                                   {"uint", "uint32"},
                                                                   {"float", "float32"},
                                                                   {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (name == kNames[i][0] || name == kNames[i][1]) return static_cast<Number>(i);
  return std::nullopt;
}

enum class Use { kNothing, kX, kY, kZ, kNormalX, kNormalY, kNormalZ, kU, kV, kCorners };

struct Property {
  Number number;
  std::optional<Number> count;  // of a list
  Use use = Use::kNothing;
};

struct Element {
  std::string_view name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

Use use_of(std::string_view element, std::string_view property) {
  struct Row {
    std::string_view name;
    Use use;
  };
  constexpr std::array kVertex{Row{"x", Use::kX},         Row{"y", Use::kY},         Row{"z", Use::kZ},
                               Row{"nx", Use::kNormalX},  Row{"ny", Use::kNormalY},  Row{"nz", Use::kNormalZ},
                               Row{"u", Use::kU},         Row{"v", Use::kV},         Row{"s", Use::kU},
                               Row{"t", Use::kV},         Row{"texture_u", Use::kU}, Row{"texture_v", Use::kV},
                               Row{"texture_s", Use::kU}, Row{"texture_t", Use::kV}};
  if (element == "vertex")
    for (const Row& row : kVertex)
      if (row.name == property) return row.use;
  if (element == "face" && (property == "vertex_indices" || property == "vertex_index")) return Use::kCorners;
  return Use::kNothing;
}

template <class T>
T load(const char* at, bool swap) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), at, sizeof(T));
  if (swap) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::string& source) : bytes_(bytes), source_(source) { read_header(); }

  Mesh mesh() {
    for (const Element& element : elements_) {
      if (element.properties.empty()) continue;
      element_ = &element;
      const std::size_t least = least_size(element);
      if (element.count > left() / least)
        refuse("ends before its " + std::to_string(element.count) + " elements " + in_quotes(element.name) +
               " (they take at least " + std::to_string(least) + " bytes each)");
      if (element.name == "vertex") prepare_vertices(element);
      if (element.name == "face") out_.triangles.reserve(element.count);
      for (std::size_t i = 0; i < element.count; ++i)
        for (const Property& property : element.properties) read(property, i);
    }
    if (!had_corners_) refuse("has no element \"face\" with a list \"vertex_indices\"; expected a mesh of triangles");
    const auto count = out_.positions.size();
    for (const auto& t : out_.triangles)
      for (const Index corner : t)
        if (corner >= count)
          refuse("a face names vertex " + std::to_string(corner) + ", but there are " + std::to_string(count));
    return std::move(out_);
  }

 private:
  [[noreturn]] void refuse(const std::string& text) const {
    throw files::InputError(source_ + ":" + std::to_string(words_.line()) + ": " + text);
  }

  void read_header() {
    if (words_.next() != "ply") refuse("does not begin with \"ply\"; expected a PLY file");
    for (words_.skip_line();; words_.skip_line()) {
      const std::string_view word = words_.next();
      if (word == "end_header") break;
      if (word.empty() && words_.is_at_end()) refuse("ends within its header");
      if (word == "format") read_format();
      else if (word == "element") read_element();
      else if (word == "property") read_property();
      else if (word != "comment" && word != "obj_info" && !word.empty())
        refuse("the header has the word " + in_quotes(word) + "; expected element, property, comment or end_header");
    }
    if (!has_format_) refuse("the header has no line \"format\"");
    words_.skip_line();
    at_ = bytes_.data() + (bytes_.size() - words_.left());
  }

  void read_format() {
    const std::string_view word = words_.next();
    if (word == "ascii") is_text_ = true;
    else if (word == "binary_big_endian") swap_ = std::endian::native == std::endian::little;
    else if (word == "binary_little_endian") swap_ = std::endian::native == std::endian::big;
    else refuse("the format is " + in_quotes(word) + "; expected ascii, binary_little_endian or binary_big_endian");
    has_format_ = true;
  }

  void read_element() {
    Element element{words_.next(), 0, {}};
    std::uint64_t count = 0;
    if (!words_.number(count) || count > 0xfffffffe)
      refuse("element " + in_quotes(element.name) + " has no count; expected a whole number below 2^32");
    for (const Element& other : elements_)
      if (other.name == element.name) refuse("element " + in_quotes(element.name) + " is declared twice");
    element.count = static_cast<std::size_t>(count);
    elements_.push_back(std::move(element));
    if (elements_.size() > 64) refuse("declares more than 64 elements");
  }

  void read_property() {
    if (elements_.empty()) refuse("has a property before its first element");
    Element& element = elements_.back();
    std::string_view word = words_.next();
    Property property{};
    if (word == "list") {
      word = words_.next();
      property.count = number_of_name(word);
      if (!property.count || *property.count >= Number::kFloat)
        refuse("a list is counted by " + in_quotes(word) + "; expected an integer type");
      word = words_.next();
    }
    const auto number = number_of_name(word);
    if (!number) refuse("a property has the type " + in_quotes(word) + "; expected char, uchar, ... float, double");
    property.number = *number;
    property.use = use_of(element.name, words_.next());
    if ((property.use == Use::kCorners) != property.count.has_value()) property.use = Use::kNothing;
    if (property.use == Use::kCorners && property.number >= Number::kFloat)
      refuse("the corners of faces are " + in_quotes(word) + "; expected an integer type");
    element.properties.push_back(property);
    if (element.properties.size() > 256) refuse("declares more than 256 properties of an element");
  }

  // Bytes that an element takes at least: in text a digit and a blank.
  std::size_t least_size(const Element& element) const {
    std::size_t size = 0;
    for (const Property& p : element.properties)
      size += is_text_ ? 1 : kSizes[static_cast<std::size_t>(p.count ? *p.count : p.number)];
    return size;
  }

  std::size_t left() const {
    return is_text_ ? words_.left() : static_cast<std::size_t>(bytes_.data() + bytes_.size() - at_);
  }

  void prepare_vertices(const Element& element) {
    const auto has = [&](Use use) {
      for (const Property& p : element.properties)
        if (p.use == use) return true;
      return false;
    };
    if (!has(Use::kX) || !has(Use::kY) || !has(Use::kZ)) refuse("vertices have no x, y and z");
    out_.positions.resize(element.count);
    if (has(Use::kNormalX) && has(Use::kNormalY) && has(Use::kNormalZ)) out_.normals.resize(element.count);
    if (has(Use::kU) && has(Use::kV)) out_.uvs.resize(element.count);
  }

  template <class T>
  T next(Number number) {
    if (is_text_) {
      double value = 0;
      words_.skip_blank_lines();
      if (words_.is_at_end()) refuse("ends within its elements " + in_quotes(element_->name));
      if (!words_.number(value)) refuse("has the word " + in_quotes(words_.next()) + "; expected a number");
      return whole_or<T>(value);
    }
    const std::size_t size = kSizes[static_cast<std::size_t>(number)];
    if (left() < size) refuse("ends within its elements " + in_quotes(element_->name));
    const char* at = at_;
    at_ += size;
    switch (number) {
      case Number::kInt8:
        return static_cast<T>(load<std::int8_t>(at, swap_));
      case Number::kUint8:
        return static_cast<T>(load<std::uint8_t>(at, swap_));
      case Number::kInt16:
        return static_cast<T>(load<std::int16_t>(at, swap_));
      case Number::kUint16:
        return static_cast<T>(load<std::uint16_t>(at, swap_));
      case Number::kInt32:
        return static_cast<T>(load<std::int32_t>(at, swap_));
      case Number::kUint32:
        return static_cast<T>(load<std::uint32_t>(at, swap_));
      case Number::kFloat:
        return whole_or<T>(static_cast<double>(load<float>(at, swap_)));
      case Number::kDouble:
        return whole_or<T>(load<double>(at, swap_));
    }
    return T{};
  }

  // A float as it is, beyond its range as infinity; as an integer -1 if it is none.
  template <class T>
  static T whole_or(double value) {
    if constexpr (std::is_integral_v<T>) return value >= -1 && value < 4294967296.0 ? static_cast<T>(value) : T{-1};
    else return std::abs(value) > 3e38 ? static_cast<T>(std::copysign(HUGE_VALF, value)) : static_cast<T>(value);
  }

  void read(const Property& property, std::size_t i) {
    if (property.count) {
      const auto count = next<std::int64_t>(*property.count);
      const std::size_t least = is_text_ ? 1 : kSizes[static_cast<std::size_t>(property.number)];
      if (count < 0 || static_cast<std::size_t>(count) > left() / least)
        refuse("a list has " + std::to_string(count) + " entries, more than the file holds");
      if (property.use == Use::kCorners) read_face(property.number, static_cast<std::size_t>(count));
      else
        for (std::int64_t k = 0; k < count; ++k) next<float>(property.number);
      return;
    }
    const float value = next<float>(property.number);
    switch (property.use) {
      case Use::kX:
        out_.positions[i].x = value;
        break;
      case Use::kY:
        out_.positions[i].y = value;
        break;
      case Use::kZ:
        out_.positions[i].z = value;
        break;
      case Use::kNormalX:
        store(out_.normals, i, 0, value);
        break;
      case Use::kNormalY:
        store(out_.normals, i, 1, value);
        break;
      case Use::kNormalZ:
        store(out_.normals, i, 2, value);
        break;
      case Use::kU:
        store(out_.uvs, i, 0, value);
        break;
      case Use::kV:
        store(out_.uvs, i, 1, value);
        break;
      case Use::kCorners:
      case Use::kNothing:
        break;
    }
  }

  template <class V>
  static void store(std::vector<V>& list, std::size_t i, int axis, float value) {
    if (!list.empty()) list[i][axis] = value;
  }

  void read_face(Number number, std::size_t count) {
    had_corners_ = true;
    Index first = 0, last = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const auto corner = next<std::int64_t>(number);
      if (corner < 0 || corner >= kNone)
        refuse("a face names vertex " + std::to_string(corner) + ", but vertices count from 0");
      const auto index = static_cast<Index>(corner);
      if (k >= 2) out_.triangles.push_back({first, last, index});
      if (k == 0) first = index;
      last = index;
    }
  }

  std::string_view bytes_;
  const std::string& source_;
  Words words_{bytes_};
  const char* at_ = nullptr;
  bool has_format_ = false, is_text_ = false, swap_ = false, had_corners_ = false;
  std::vector<Element> elements_;
  const Element* element_ = nullptr;
  Mesh out_;
};

}  // namespace

MeshFile ply_of(std::string_view bytes, const std::filesystem::path& file, const std::string& part, Loading&) {
  const std::string source = file.string();
  if (!part.empty()) throw files::InputError(source + ": has no parts, as PLY files; leave out \"part\"");
  MeshFile out;
  out.meshes.push_back(PlyReader(bytes, source).mesh());
  out.parts.push_back({"", 0, kNone, glm::dmat4(1)});
  return out;
}

}  // namespace likeness::scene
