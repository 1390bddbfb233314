#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// A small table of measurements in a CSV file: a header of names, then rows of numbers, some columns of text.
namespace likeness::columns {

inline constexpr std::size_t kMostBytes = 1 << 20, kMostRows = 10'000, kMostColumns = 64;

struct Row {
  std::size_t line = 0;            // of the file, counted from 1
  std::vector<std::string> texts;  // of the columns of text, in the order in which they were asked for
  std::vector<double> numbers;     // of all other columns, in the file's order; finite
};

struct Columns {
  std::string source;
  std::vector<std::string> names;  // of the columns of numbers
  std::vector<Row> rows;           // at least one

  // The index into `numbers`; throws files::InputError if there is no such column.
  std::size_t index_of(std::string_view name) const;
  bool has(std::string_view name) const;
  // "source:line: text", as files::InputError.
  [[noreturn]] void refuse(const Row& row, const std::string& text) const;
};

// `texts` are the names of columns that hold text; one that the file lacks is empty everywhere. '#' begins a line of
// comment; empty lines are passed over. Throws files::InputError, one line that begins with `source` and the line number,
// for a missing header, a name that comes twice, a row of another length, a cell that is no finite number, and what is
// beyond the limits above.
Columns parse(std::string_view bytes, const std::string& source, std::span<const std::string_view> texts);
Columns read(const std::filesystem::path& file, std::span<const std::string_view> texts);

}  // namespace likeness::columns
