#pragma once

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "brdf/evaluator.h"
#include "tests/brdf/kinds.h"

// Rows of a table of reference values, through an evaluator in any kind of scalar.
namespace likeness::brdf {

using Row = std::map<std::string, double>;

// Columns by name, of a table in CSV. Empty if there is no such file.
inline std::vector<Row> read_rows(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> names;
  std::vector<Row> rows;
  for (std::string line, cell; std::getline(file, line);) {
    if (line.ends_with('\r')) line.pop_back();
    std::istringstream cells(line);
    if (names.empty()) {
      while (std::getline(cells, cell, ',')) names.push_back(cell);
    } else {
      Row row;
      for (std::size_t i = 0; std::getline(cells, cell, ','); ++i)
        row[names.at(i)] = std::strtod(cell.c_str(), nullptr);  // 1e-343 is 0
      rows.push_back(row);
    }
  }
  return rows;
}

// The same, of a file in shared/reference.
inline std::vector<Row> read_reference(const std::string& name) {
  return read_rows(std::string(LIKENESS_SHARED_DIR) + "/reference/" + name);
}

// The inputs of a form by channel, from a row: a column holds for all channels of its parameter, what is missing has its
// default. `used` counts the columns that the form knows.
template <class Form>
std::vector<double> inputs_of(const Row& row, std::size_t& used) {
  std::vector<double> in;
  used = 0;
  for (const Parameter& p : Form::kInputs) {
    const auto cell = row.find(std::string(p.name));
    used += cell != row.end();
    in.insert(in.end(), static_cast<std::size_t>(p.channels), cell == row.end() ? p.initial : cell->second);
  }
  return in;
}

// The outputs of one row in S: inputs and features in double, as `likeness eval` has them, then rounded.
template <class E, Scalar S, class Form = std::tuple_element_t<0, typename E::Forms>>
std::vector<double> evaluate_row(const std::vector<double>& in) {
  double features[feature_count<E>()];
  Form::prepare(in.data(), features);
  S rounded[feature_count<E>()], out[output_count<E>()];
  for (std::size_t i = 0; i < feature_count<E>(); ++i) rounded[i] = constant<S>(features[i]);
  const void* tables = nullptr;
  if constexpr (HasTables<E>) tables = &E::tables();
  evaluate_features<E>(tables, rounded, out);
  std::vector<double> result;
  for (const S& x : out) result.push_back(first(x));
  return result;
}

// What is to be expected of a file: the relative error in double and in float, and the size below which a value counts
// as 0 in either.
struct Tolerance {
  double in_double = 1e-12, in_float = 2e-5;
  double zero_double = 1e-300, zero_float = 1.2e-38;
};

// Every row of shared/reference/FILE, in S, against its ref_ columns. Returns the worst relative difference.
template <class E, Scalar S, class Form = std::tuple_element_t<0, typename E::Forms>>
double worst_against_file(const std::string& file, const Tolerance& tolerance) {
  double worst = 0;
  const auto rows = read_reference(file);
  for (std::size_t line = 0; line < rows.size(); ++line) {
    std::size_t used = 0, references = 0;
    const std::vector<double> in = inputs_of<Form>(rows[line], used);
    const std::vector<double> got = evaluate_row<E, S, Form>(in);
    std::size_t at = 0;
    for (const Output& output : E::kOutputs) {
      const auto want = rows[line].find("ref_" + std::string(output.name));
      for (int channel = 0; channel < output.channels; ++channel, ++at) {
        if (want == rows[line].end()) continue;
        const double zero = kIsFloat<S> ? tolerance.zero_float : tolerance.zero_double;
        const double difference = relative_difference(got[at], want->second, zero);
        worst = std::max(worst, difference);
        EXPECT_LE(difference, kIsFloat<S> ? tolerance.in_float : tolerance.in_double)
            << file << " line " << line + 2 << ", " << output.name << ": got " << got[at] << ", want " << want->second;
      }
      references += want != rows[line].end();
    }
    EXPECT_EQ(used + references, rows[line].size()) << file << ": a column that " << E::kName << " does not know";
    EXPECT_GT(references, 0u) << file << ": no column of results";
  }
  return worst;
}

}  // namespace likeness::brdf
