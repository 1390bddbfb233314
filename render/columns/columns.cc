#include "render/columns/columns.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "brdf/eval/csv.h"
#include "render/files/files.h"

namespace likeness::columns {
namespace {

[[noreturn]] void refuse_line(const std::string& source, std::size_t line, const std::string& text) {
  throw files::InputError(source + ":" + std::to_string(line) + ": " + text);
}

// Where each column of the file goes: to texts[index] or to numbers.
struct Target {
  bool is_text = false;
  std::size_t index = 0;
};

std::vector<std::string> cells_of(std::string_view line, const std::string& source, std::size_t at) {
  std::vector<std::string> cells;
  for (bool last = false; !last;) {
    const auto cell = eval::take_cell(line, last);
    if (!cell) refuse_line(source, at, "a quote is not closed, or is followed by more than a comma");
    cells.emplace_back(*cell);
    if (cells.size() > kMostColumns) refuse_line(source, at, "more than " + std::to_string(kMostColumns) + " columns");
  }
  return cells;
}

// The next line that is neither empty nor a comment; nothing at the end.
std::optional<std::string_view> next_line(std::string_view& bytes, std::size_t& number) {
  while (!bytes.empty()) {
    const std::string_view line = eval::trimmed(eval::take_line(bytes));
    ++number;
    if (!line.empty() && !line.starts_with('#')) return line;
  }
  return std::nullopt;
}

}  // namespace

bool Columns::has(std::string_view name) const { return std::find(names.begin(), names.end(), name) != names.end(); }

std::size_t Columns::index_of(std::string_view name) const {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  std::string there;
  for (const std::string& known : names) there += (there.empty() ? "" : ", ") + files::in_quotes(known);
  throw files::InputError(source + ": no column " + files::in_quotes(name) + "; there are " + there);
}

void Columns::refuse(const Row& row, const std::string& text) const { refuse_line(source, row.line, text); }

Columns parse(std::string_view bytes, const std::string& source, std::span<const std::string_view> texts) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  Columns out;
  out.source = source;
  std::size_t line_number = 0;
  const auto header = next_line(bytes, line_number);
  if (!header) throw files::InputError(source + ": empty; the first line names the columns");
  const std::vector<std::string> names = cells_of(*header, source, line_number);
  std::vector<Target> targets;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) refuse_line(source, line_number, "column " + std::to_string(i + 1) + " has no name");
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i))
      refuse_line(source, line_number, "two columns are named " + files::in_quotes(names[i]));
    const auto text = std::find(texts.begin(), texts.end(), names[i]);
    if (text != texts.end()) {
      targets.push_back({true, static_cast<std::size_t>(text - texts.begin())});
    } else {
      targets.push_back({false, out.names.size()});
      out.names.push_back(names[i]);
    }
  }
  while (const auto line = next_line(bytes, line_number)) {
    if (out.rows.size() == kMostRows)
      refuse_line(source, line_number, "more than " + std::to_string(kMostRows) + " rows");
    const std::vector<std::string> cells = cells_of(*line, source, line_number);
    if (cells.size() != names.size())
      refuse_line(
          source, line_number,
          std::to_string(cells.size()) + " cells; the header names " + std::to_string(names.size()) + " columns");
    Row row{line_number, std::vector<std::string>(texts.size()), std::vector<double>(out.names.size())};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (targets[i].is_text) {
        row.texts[targets[i].index] = cells[i];
        continue;
      }
      const auto number = eval::number_in(cells[i]);
      if (!number || !std::isfinite(*number))
        refuse_line(source, line_number,
                    names[i] + " is " + files::in_quotes(cells[i]) + "; a finite number is expected");
      row.numbers[targets[i].index] = *number;
    }
    out.rows.push_back(std::move(row));
  }
  if (out.rows.empty()) throw files::InputError(source + ": a header and no rows");
  return out;
}

Columns read(const std::filesystem::path& file, std::span<const std::string_view> texts) {
  return parse(files::read_whole(file, kMostBytes), file.string(), texts);
}

}  // namespace likeness::columns
