#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/json/json.h"
#include "render/json/section.h"

namespace likeness::json {

// An object of the file, checked against its section when it is made: unknown keys, missing ones, and values of the
// wrong kind or outside their range are files::InputErrors of one line that begin "file:line: /path". What is asked
// for by name afterwards is therefore there, or is the row's default. The tree must outlive it.
class Fields {
 public:
  Fields(const std::string& source, const Value& value, const Section& section, std::string path);

  const Section& section() const { return *section_; }
  const std::string& path() const { return path_; }
  const std::string& source() const { return *source_; }
  const Value& value() const { return *value_; }

  bool has(std::string_view key) const { return value_->find(key) != nullptr; }
  // Refuses if both are given.
  void only_one_of(std::string_view a, std::string_view b) const;

  std::string text(std::string_view key) const;
  bool flag(std::string_view key) const;
  double number(std::string_view key) const;
  int whole(std::string_view key) const { return static_cast<int>(number(key)); }
  glm::dvec2 pair(std::string_view key) const;
  glm::dvec3 vector(std::string_view key) const;  // of a scale and a color too
  glm::dmat4 matrix(std::string_view key) const;  // must be given
  // A camera's matrix as a frame: columns unit and square to rounding. Refuses one that scales or mirrors.
  glm::dmat4 rigid(std::string_view key) const;
  // A list, of one if a number is given; the default, or else 0, if nothing is.
  std::vector<double> numbers(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key) const;
  // A unit vector along it; refuses one without length.
  glm::dvec3 direction(std::string_view key) const;

  // The objects of a list or a map, and their names in a map.
  std::vector<Fields> list(std::string_view key) const;
  std::optional<Fields> object(std::string_view key) const;

  // "file:line: /path/key" and the text; the line is that of the key's value.
  [[noreturn]] void refuse(std::string_view key, const std::string& text) const;
  [[noreturn]] void refuse(const std::string& text) const;

 private:
  const std::string* source_;
  const Value* value_;
  const Section* section_;
  std::string path_;
};

// Throws files::InputError: "source:line: text".
[[noreturn]] void refuse_at(const std::string& source, std::size_t line, const std::string& text);

// `; did you mean "b"?`, or, if nothing is near, `; there are a, b, c` (or `; there is none`).
std::string near_text(std::string_view wanted, const std::vector<std::string_view>& names);

}  // namespace likeness::json
