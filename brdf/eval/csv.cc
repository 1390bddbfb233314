#include "brdf/eval/csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace likeness::eval {
namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

std::optional<std::string_view> take_cell(std::string_view& line, bool& last) {
  std::string_view rest = line;
  while (!rest.empty() && blank(rest.front())) rest.remove_prefix(1);
  std::string_view cell;
  if (rest.starts_with('"')) {
    const std::size_t close = rest.find('"', 1);
    if (close == rest.npos) return std::nullopt;
    cell = rest.substr(1, close - 1);
    rest.remove_prefix(close + 1);
    while (!rest.empty() && blank(rest.front())) rest.remove_prefix(1);
    if (!rest.empty() && rest.front() != ',') return std::nullopt;
  } else {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    cell = rest.substr(0, comma);
    rest.remove_prefix(comma);
  }
  last = rest.empty();
  if (!last) rest.remove_prefix(1);
  line = rest;
  return trimmed(cell);
}

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || end != text.data() + text.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    const double size = text.find("e-") != text.npos || text.find("E-") != text.npos ? 0.0 : HUGE_VAL;
    return text.starts_with('-') ? -size : size;
  }
  if (error != std::errc{}) return std::nullopt;
  return value;
}

Numbers read_numbers(std::string_view line, std::span<double> out) {
  Numbers found;
  bool last = false;
  while (!last) {
    // Nearly every cell is a plain number that ends at its comma.
    double value = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    const bool to_the_end = end == line.data() + line.size();
    if (error == std::errc{} && (to_the_end || *end == ',')) {
      last = to_the_end;
      line.remove_prefix(static_cast<std::size_t>(end - line.data()) + (last ? 0 : 1));
    } else {
      const std::string_view from_here = line;
      const auto cell = take_cell(line, last);
      const auto number = cell ? number_in(*cell) : std::nullopt;
      if (!number) {
        found.wrong = cell.value_or(trimmed(from_here));
        return found;
      }
      value = *number;
    }
    if (found.cells < out.size()) out[found.cells] = value;
    ++found.cells;
  }
  return found;
}

void append_number(std::string& out, double value) {
  if (std::isnan(value)) {
    out += "nan";
    return;
  }
  std::array<char, 40> digits{};
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 17);
  out.append(digits.data(), end);
}

}  // namespace likeness::eval
