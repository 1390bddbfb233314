#pragma once

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "brdf/catalog/catalog.h"
#include "brdf/eval/draw.h"

// Columns of random rows for any entry of the catalog, and what its loops make of them.
namespace likeness::catalog {

using Columns = std::vector<std::vector<float>>;

// Inputs of one form within their ranges, edges over-weighted.
inline Columns drawn_inputs(const Entry& entry, const Form& form, std::size_t rows, std::uint64_t seed) {
  const eval::Draw draw(form.inputs);
  Columns columns(form.count, std::vector<float>(rows));
  std::vector<float*> at;
  for (auto& column : columns) at.push_back(column.data());
  eval::Random random(eval::stream_of(seed, entry.name), 0);
  for (std::size_t row = 0; row < rows; ++row) draw.row(random, at.data(), row);
  return columns;
}

// The features of drawn inputs, prepared in double and rounded, as `likeness eval` has them.
inline Columns features_of(const Entry& entry, const Form& form, const Columns& inputs) {
  const std::size_t rows = inputs.front().size();
  Columns columns(entry.features, std::vector<float>(rows));
  std::vector<double> in(form.count), features(entry.features);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < in.size(); ++k) in[k] = double{inputs[k][row]};
    form.prepare(in.data(), features.data());
    for (std::size_t k = 0; k < features.size(); ++k) columns[k][row] = static_cast<float>(features[k]);
  }
  return columns;
}

// What a loop makes of the first `rows` rows. Behind each column of results lie guards that must stay as they are.
inline constexpr std::size_t kGuards = 64;
inline constexpr std::uint32_t kGuard = 0xffc0dead;  // a NaN that no arithmetic makes
inline Columns results_of(const Entry& entry, Loop<float> loop, const std::vector<Column<float>>& in,
                          std::size_t rows) {
  Columns out(entry.output_count, std::vector<float>(rows + kGuards, std::bit_cast<float>(kGuard)));
  std::vector<float*> at;
  for (auto& column : out) at.push_back(column.data());
  loop(entry.tables(), in.data(), at.data(), rows);
  return out;
}
inline std::vector<Column<float>> columns_of(const Columns& columns) {
  std::vector<Column<float>> in;
  for (const auto& column : columns) in.push_back({column.data(), false});
  return in;
}
inline bool guards_hold(const Columns& out, std::size_t rows) {
  for (const auto& column : out)
    for (std::size_t i = rows; i < column.size(); ++i)
      if (std::bit_cast<std::uint32_t>(column[i]) != kGuard) return false;
  return true;
}

// Units in the last place from one float to another, through 0 if they differ in sign. 0 for two NaN.
inline std::int64_t ulps_between(float a, float b) {
  const auto place = [](float x) {
    const auto bits = std::bit_cast<std::int32_t>(x);
    return std::int64_t{bits < 0 ? std::int32_t(0x80000000u - std::uint32_t(bits)) : bits};
  };
  return a != a && b != b ? 0 : std::llabs(place(a) - place(b));
}

// A row, to repeat what failed.
inline std::string row_text(const Columns& columns, std::size_t row) {
  std::string text;
  char number[32];
  for (const auto& column : columns) {
    std::snprintf(number, sizeof number, " %.9g", double{column[row]});
    text += number;
  }
  return text;
}

}  // namespace likeness::catalog
