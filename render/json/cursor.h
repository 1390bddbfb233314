#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>

namespace likeness::json {

// A pointer into the text that tells how far the parser has read, because its events carry no position.
struct Cursor {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  const char* at;
  const char** seen;

  reference operator*() const { return *at; }
  Cursor& operator++() {
    *seen = ++at;
    return *this;
  }
  Cursor operator++(int) {
    Cursor old = *this;
    ++*this;
    return old;
  }
  bool operator==(const Cursor& other) const { return at == other.at; }
  bool operator!=(const Cursor& other) const { return at != other.at; }
};

// Of a parser's message, "[json.exception.parse_error.101] parse error at line 2, column 3: syntax error ...", the last
// part, on one line of bounded length: "not JSON (byte 7): syntax error ...".
inline std::string syntax_text(std::size_t byte, std::string text) {
  if (const auto at = text.find("] "); at != std::string::npos) text.erase(0, at + 2);
  if (text.starts_with("parse error at"))
    if (const auto at = text.find(": "); at != std::string::npos) text.erase(0, at + 2);
  if (text.size() > 160) text = text.substr(0, 160) + "...";
  std::replace(text.begin(), text.end(), '\n', ' ');
  return "not JSON (byte " + std::to_string(byte) + "): " + text;
}

// The line, from 1, of a byte that a parser counts from 1.
inline std::size_t line_of_byte(const char* begin, std::size_t byte) {
  return 1 + static_cast<std::size_t>(std::count(begin, begin + (byte > 0 ? byte - 1 : 0), '\n'));
}

}  // namespace likeness::json
