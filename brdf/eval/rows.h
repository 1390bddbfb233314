#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/catalog/catalog.h"
#include "brdf/eval/columns.h"

// Rows of a table through an evaluator, in memory.
namespace likeness::eval {

enum class Precision { kDouble, kFloat, kBatch };
inline constexpr std::array<std::string_view, 3> kPrecisionNames{"double", "float", "batch"};

// The largest relative difference from a column of references: |got - want| / max(|got|, |want|), where both below the
// least normal number of the precision count as equal.
struct Worst {
  double difference = 0, got = 0, want = 0;
  std::size_t row = 0, line = 0;  // row: counted from 1 within the table; 0 if no row differs
};

// What became of some rows, in order.
struct Outcome {
  std::string text;           // the rows with their outputs
  std::size_t rows = 0;       // that were evaluated
  std::size_t outside = 0;    // rows with an input outside its range
  std::string first_outside;  // "roughness = 1.2 is outside [0, 1]"
  std::size_t outside_line = 0;
  std::size_t colored = 0;   // rows whose channels differ although one column holds all three
  std::vector<Worst> worst;  // one for each column of references; rows counted from 1 within the outcome

  // Adds the outcome of the rows that follow; its text is left to it.
  void add(const Outcome& next);
};

// The first line of a table that is not blank; `text` goes on after it, and `line` is its number. A byte order mark is
// left out. Nothing if there is no such line.
std::optional<std::string_view> take_header(std::string_view& text, std::size_t& line);

// A header that is understood: evaluates rows, from any number of threads.
class Rows {
 public:
  // `header` is the table's first line, in line `line` of the file `name`. Throws as columns_of does.
  Rows(const catalog::Entry& entry, std::string_view header, std::span<const Assignment> assignments,
       Precision precision, std::string name, std::size_t line = 1);

  const Columns& columns() const { return columns_; }

  // The header with the names of the outputs, and the line's own ending.
  std::string header() const;

  // Lines of the table, of which the first has that number in the file. Blank lines are left out. Throws
  // files::InputError for a row that is none, naming file and line, and files::Interrupted.
  Outcome evaluate(std::string_view lines, std::size_t first_line) const;

 private:
  struct Chunk;
  void read_row(std::string_view line, std::size_t line_number, Chunk& chunk, Outcome& outcome) const;
  void evaluate_chunk(Chunk& chunk, Outcome& outcome) const;
  void compare(const Chunk& chunk, std::size_t row, Outcome& outcome) const;
  [[noreturn]] void refuse(std::size_t line, const std::string& text) const;

  const catalog::Entry& entry_;
  Precision precision_;
  std::string name_, header_;
  Columns columns_;
  std::vector<std::string> column_names_;
  std::vector<brdf::Interval> ranges_;  // of every input, by channel
  std::vector<std::string> input_names_;
  const void* tables_;
};

}  // namespace likeness::eval
