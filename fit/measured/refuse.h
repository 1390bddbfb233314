#pragma once

#include <string>
#include <string_view>

#include "render/files/files.h"

namespace likeness::measured {

// Ends reading with one line: the file, what was found in it, what was expected.
[[noreturn]] inline void refuse(const std::string& file, const std::string& found, const std::string& expected) {
  throw files::InputError(file + ": " + found + "; expected " + expected);
}

// Text out of a file, fit for a one-line message: quoted, at most 40 characters, other bytes as '?'.
inline std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (text.size() > 40 ? "...\"" : "\"");
}

}  // namespace likeness::measured
