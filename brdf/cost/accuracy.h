#pragma once

#include <string>
#include <vector>

#include "brdf/catalog/catalog.h"
#include "brdf/cost/ladder.h"

// How far a form is from the reference of its family, over the family's draws.
namespace likeness::cost {

enum class Precision { kDouble, kFloat, kBatch };
inline constexpr std::string_view kPrecisionNames[]{"double", "float", "batch"};

// Draws of a family, row by row.
struct Draws {
  std::size_t count = 0;
  std::vector<double> rows;  // count x family.draw_names.size()
};
Draws draws_of(const Family& family, std::size_t count);

// The inputs of an evaluator's first form for all draws, as columns.
struct Columns {
  std::vector<std::vector<double>> of_double;
  std::vector<std::vector<float>> of_float;
};
Columns columns_of(const Family& family, const Rung& rung, const catalog::Entry& entry, const Draws& draws);

// The compared value of each draw.
std::vector<double> values_of(const Rung& rung, const catalog::Entry& entry, const Draws& draws, const Columns& columns,
                              Precision precision);

// Of value x weight (Family::value_weight), but for `energy`.
struct Accuracy {
  double rms = 0;     // root of the mean squared difference, over that of the reference's values
  double worst = 0;   // largest |difference| / max(|reference|, family.negligible x the reference's root mean square)
  std::string where;  // its draw
  double energy = 0;  // weighted sum over that of the reference, minus 1, of the bin where it is farthest from 0; NaN
                      // if the family has no energy
};
Accuracy accuracy_of(const Family& family, const Draws& draws, const std::vector<double>& values,
                     const std::vector<double>& reference);

}  // namespace likeness::cost
