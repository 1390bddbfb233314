#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// JSON as a tree that remembers its lines, so that whoever finds fault with a value can say where it stands.
namespace likeness::json {

enum class Kind : std::uint8_t { kNull, kFlag, kNumber, kText, kList, kObject };

struct Value {
  Kind kind = Kind::kNull;
  std::uint32_t line = 1;    // of the token; of a list or an object: of its bracket
  double number = 0;         // a flag: 0 or 1
  std::string text;          // UTF-8
  std::string key;           // of a member of an object
  std::vector<Value> items;  // of a list, or the members of an object in the order of the text

  // The member of that name, or null.
  const Value* find(std::string_view name) const;

  bool is_number() const { return kind == Kind::kNumber; }
  bool is_text() const { return kind == Kind::kText; }
  bool is_list() const { return kind == Kind::kList; }
  bool is_object() const { return kind == Kind::kObject; }
};

// What a hostile text may cost: a value takes about 100 bytes.
struct Limits {
  std::size_t values = 2'000'000;
  std::size_t depth = 64;
};

// Throws files::InputError, one line that begins with `source` and the line number, for what is not JSON (RFC 8259: no
// comments, no NaN, no trailing commas), names a member of an object twice, or is beyond the limits.
Value parse(std::string_view text, const std::string& source, const Limits& limits = {});

// What a value is, for "... is the text "a"; expected a number".
std::string kind_text(const Value& value);

// A key as it may stand in a message: on one line, of bounded length, without quotes.
std::string plain(std::string_view key);

}  // namespace likeness::json
