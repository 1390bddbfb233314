#include "brdf/eval/rows.h"

#include <algorithm>
#include <cmath>

#include "brdf/eval/csv.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"

namespace likeness::eval {
namespace {

using files::in_quotes;
using files::number_text;

constexpr std::size_t kChunk = 256;      // rows that are evaluated together: their columns stay in the cache
constexpr double kUnitTolerance = 1e-6;  // of the length of a direction
constexpr double kRangeSlack = 1e-6;     // relative: pi/2 written with 7 digits is not worth a warning

double relative_difference(double got, double want, double zero) {
  if (got == want || (std::isnan(got) && std::isnan(want))) return 0;
  const double difference = std::abs(got - want), size = std::max(std::abs(got), std::abs(want));
  if (std::isnan(difference) || std::isinf(size)) return std::numeric_limits<double>::infinity();
  return size <= zero ? 0 : difference / size;
}

// The header's names, without quotes.
std::vector<std::string_view> names_in(std::string_view header, const std::string& place) {
  std::vector<std::string_view> names;
  for (bool last = false; !last;) {
    const auto cell = take_cell(header, last);
    if (!cell) throw files::InputError(place + ": a quote that is not closed; expected names separated by commas");
    names.push_back(*cell);
  }
  return names;
}

}  // namespace

void Outcome::add(const Outcome& next) {
  if (outside == 0) {
    first_outside = next.first_outside;
    outside_line = next.outside_line;
  }
  worst.resize(std::max(worst.size(), next.worst.size()));
  for (std::size_t i = 0; i < next.worst.size(); ++i)
    if (next.worst[i].row > 0 && (worst[i].row == 0 || next.worst[i].difference > worst[i].difference)) {
      worst[i] = next.worst[i];
      worst[i].row += rows;
    }
  rows += next.rows;
  outside += next.outside;
  colored += next.colored;
}

std::optional<std::string_view> take_header(std::string_view& text, std::size_t& line) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  for (; !text.empty(); ++line)
    if (const std::string_view header = take_line(text); !trimmed(header).empty()) return header;
  return std::nullopt;
}

// Rows that are read and not yet evaluated.
struct Rows::Chunk {
  std::size_t rows = 0;
  std::vector<double> cells;     // of the table, row by row
  std::vector<double> in;        // of one row
  std::vector<double> features;  // of one row
  std::vector<double> columns;   // features, then outputs: kChunk values each
  std::vector<float> in_float;   // the same
  std::vector<std::string_view> lines;
  std::vector<std::size_t> line_numbers;

  double* column(std::size_t i) { return columns.data() + i * kChunk; }
  const double* column(std::size_t i) const { return columns.data() + i * kChunk; }
};

Rows::Rows(const catalog::Entry& entry, std::string_view header, std::span<const Assignment> assignments,
           Precision precision, std::string name, std::size_t line)
    : entry_(entry), precision_(precision), name_(std::move(name)), header_(header) {
  const std::string place = name_ + ":" + std::to_string(line);
  const std::vector<std::string_view> names = names_in(header_, place);
  columns_ = columns_of(entry, names, assignments, place);
  column_names_.assign(names.begin(), names.end());
  for (const brdf::Parameter& p : columns_.form->inputs)
    for (int c = 0; c < p.channels; ++c) {
      ranges_.push_back(p.range);
      input_names_.push_back(std::string(p.name) +
                             std::string(p.channels == 3 ? kChannelSuffixes[static_cast<std::size_t>(c)] : ""));
    }
  tables_ = entry.tables();
}

std::string Rows::header() const {
  std::string text = header_;
  const bool crlf = text.ends_with('\r');
  if (crlf) text.pop_back();
  for (const Columns::Output& output : columns_.outputs) text += "," + output.name;
  return text + (crlf ? "\r\n" : "\n");
}

void Rows::refuse(std::size_t line, const std::string& text) const {
  throw files::InputError(name_ + ":" + std::to_string(line) + ": " + text);
}

void Rows::read_row(std::string_view line, std::size_t line_number, Chunk& chunk, Outcome& outcome) const {
  double* const cells = chunk.cells.data() + chunk.rows * columns_.count;
  const Numbers found = read_numbers(line, std::span(cells, columns_.count));
  if (found.wrong && found.cells < columns_.count)
    refuse(line_number, "column " + column_names_[found.cells] + " holds " +
                            (found.wrong->empty() ? "nothing; leave the whole column out to take the default"
                                                  : in_quotes(*found.wrong) + "; expected a number"));
  if (found.wrong || found.cells != columns_.count)
    refuse(line_number, (found.wrong || found.cells > columns_.count ? "more than " + std::to_string(columns_.count)
                                                                     : std::to_string(found.cells)) +
                            " values; expected " + std::to_string(columns_.count) + ", as the header has");

  std::vector<double>& in = chunk.in;
  in = columns_.fixed;
  for (const Columns::Input& input : columns_.inputs)
    for (std::size_t c = 0; c < input.channels; ++c) in[input.first + c] = cells[input.column];

  for (const std::size_t first : columns_.directions) {
    const double x = in[first], y = in[first + 1], z = in[first + 2], length = std::sqrt(x * x + y * y + z * z);
    if (!(std::abs(length - 1) <= kUnitTolerance))
      refuse(line_number, "(" + input_names_[first] + ", " + input_names_[first + 1] + ", " + input_names_[first + 2] +
                              ") = (" + number_text(x) + ", " + number_text(y) + ", " + number_text(z) +
                              ") has the length " + number_text(length) + "; expected a unit vector, to 1e-6");
  }

  bool outside = false;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const brdf::Interval& range = ranges_[i];
    if (in[i] >= range.low - kRangeSlack * std::abs(range.low) &&
        in[i] <= range.high + kRangeSlack * std::abs(range.high))
      continue;  // false for NaN
    if (!outside && outcome.outside == 0) {
      outcome.outside_line = line_number;
      outcome.first_outside = input_names_[i] + " = " + number_text(in[i]) + " is outside [" + number_text(range.low) +
                              ", " + number_text(range.high) + "]";
    }
    outside = true;
  }
  outcome.outside += outside;

  columns_.form->prepare(in.data(), chunk.features.data());
  for (std::size_t i = 0; i < chunk.features.size(); ++i) chunk.column(i)[chunk.rows] = chunk.features[i];
  chunk.lines.push_back(line);
  chunk.line_numbers.push_back(line_number);
  ++chunk.rows;
}

namespace {

template <class N>
void run(const catalog::Loop<N> loop, const void* tables, N* columns, std::size_t features, std::size_t outputs,
         std::size_t rows) {
  std::vector<catalog::Column<N>> in(features);
  std::vector<N*> out(outputs);
  for (std::size_t i = 0; i < features; ++i) in[i].data = columns + i * kChunk;
  for (std::size_t i = 0; i < outputs; ++i) out[i] = columns + (features + i) * kChunk;
  loop(tables, in.data(), out.data(), rows);
}

}  // namespace

void Rows::evaluate_chunk(Chunk& chunk, Outcome& outcome) const {
  if (files::interrupted()) throw files::Interrupted{};
  const std::size_t features = entry_.features, outputs = entry_.output_count;
  if (precision_ == Precision::kDouble) {
    run(entry_.in_double.from_features, tables_, chunk.columns.data(), features, outputs, chunk.rows);
  } else {
    const auto& loops = precision_ == Precision::kFloat ? entry_.in_float : entry_.in_batches;
    chunk.in_float.resize(chunk.columns.size());
    for (std::size_t i = 0; i < features; ++i)
      for (std::size_t row = 0; row < chunk.rows; ++row)
        chunk.in_float[i * kChunk + row] = static_cast<float>(chunk.column(i)[row]);
    run(loops.from_features, tables_, chunk.in_float.data(), features, outputs, chunk.rows);
    for (std::size_t i = features; i < features + outputs; ++i)
      for (std::size_t row = 0; row < chunk.rows; ++row)
        chunk.column(i)[row] = static_cast<double>(chunk.in_float[i * kChunk + row]);
  }
  for (std::size_t row = 0; row < chunk.rows; ++row) {
    std::string_view line = chunk.lines[row];
    const bool crlf = line.ends_with('\r');
    if (crlf) line.remove_suffix(1);
    outcome.text += line;
    for (const Columns::Output& output : columns_.outputs) {
      outcome.text += ',';
      append_number(outcome.text, chunk.column(features + output.output)[row]);
    }
    outcome.text += crlf ? "\r\n" : "\n";
    ++outcome.rows;
    compare(chunk, row, outcome);
  }
  chunk.rows = 0;
  chunk.lines.clear();
  chunk.line_numbers.clear();
}

void Rows::compare(const Chunk& chunk, std::size_t row, Outcome& outcome) const {
  const auto output = [&](std::size_t i) { return chunk.column(entry_.features + i)[row]; };
  const double zero =
      precision_ == Precision::kDouble ? std::numeric_limits<double>::min() : double{std::numeric_limits<float>::min()};
  for (std::size_t i = 0; i < columns_.references.size(); ++i) {
    const Columns::Reference& reference = columns_.references[i];
    const double want = chunk.cells[row * columns_.count + reference.column];
    for (std::size_t c = 0; c < reference.channels; ++c) {
      const double got = output(reference.output + c), difference = relative_difference(got, want, zero);
      if (difference > outcome.worst[i].difference)
        outcome.worst[i] = {difference, got, want, outcome.rows, chunk.line_numbers[row]};
    }
  }
  if (!columns_.grey) return;
  bool colored = false;
  std::size_t first = 0;
  for (const brdf::Output& o : entry_.outputs) {
    for (std::size_t c = 1; o.channels == 3 && c < 3; ++c)
      colored |= output(first + c) != output(first) && !std::isnan(output(first));
    first += static_cast<std::size_t>(o.channels);
  }
  outcome.colored += colored;
}

Outcome Rows::evaluate(std::string_view lines, std::size_t first_line) const {
  Outcome outcome;
  outcome.worst.resize(columns_.references.size());
  outcome.text.reserve(lines.size() * 5 / 4);
  Chunk chunk;
  chunk.cells.resize(kChunk * columns_.count);
  chunk.features.resize(entry_.features);
  chunk.columns.resize(kChunk * (entry_.features + entry_.output_count));
  for (std::size_t line_number = first_line; !lines.empty(); ++line_number) {
    const std::string_view line = take_line(lines);
    if (trimmed(line).empty()) continue;
    read_row(line, line_number, chunk, outcome);
    if (chunk.rows == kChunk) evaluate_chunk(chunk, outcome);
  }
  if (chunk.rows > 0) evaluate_chunk(chunk, outcome);
  return outcome;
}

}  // namespace likeness::eval
