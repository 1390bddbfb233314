#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

// Comma-separated text: lines, cells and numbers, without a copy of anything.
namespace likeness::eval {

// Without the spaces, tabs and the carriage return around it.
std::string_view trimmed(std::string_view text);

// The text before the next newline, without that; `text` goes on after it.
std::string_view take_line(std::string_view& text);

// The next cell of a line, trimmed and without its quotes; `line` goes on after the comma, `last` says that there was
// none. Nothing if a quote is not closed or is followed by more than a comma.
std::optional<std::string_view> take_cell(std::string_view& line, bool& last);

// A number as written: "nan" and "inf" in any case, a leading '+', and what is too large or too small for a double
// (as infinity and 0) included. Nothing if the text is no number.
std::optional<double> number_in(std::string_view text);

// The numbers of a line, as many as there is room for. `cells` is how many cells the line has, or the index of the
// first that is no number, which `wrong` then holds.
struct Numbers {
  std::size_t cells = 0;
  std::optional<std::string_view> wrong;
};
Numbers read_numbers(std::string_view line, std::span<double> out);

// Appends a number with 17 significant digits, which read back as the same double; "nan" whatever its sign.
void append_number(std::string& out, double value);

}  // namespace likeness::eval
