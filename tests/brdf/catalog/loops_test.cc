#include <gtest/gtest.h>

#include <cmath>

#include "tests/brdf/catalog/drawn_rows.h"

// The loops over rows: any count, columns that hold one value for all rows, and nothing written beyond the last row.
namespace likeness::catalog {
namespace {

constexpr std::size_t kRows = 67;  // no multiple of any width

// For what takes milliseconds a row, a Monte Carlo or an adaptive rule: three rows of usual inputs, from the lower end,
// where the counts of samples are least.
constexpr std::size_t kSlowRows = 3;
Columns usual_inputs(const Form& form) {
  Columns columns;
  for (const brdf::Parameter& p : form.inputs) {
    std::vector<float> column;
    for (std::size_t row = 0; row < kSlowRows; ++row) {
      const double t = 0.1 * double(row), low = p.typical.low, high = p.typical.high;
      column.push_back(float(p.logarithmic ? low * std::pow(high / low, t) : low + t * (high - low)));
    }
    columns.insert(columns.end(), std::size_t(p.channels), column);
  }
  return columns;
}

// Calls visit(entry, columns, rows, loop) for each loop of each entry.
template <class F>
void for_each_loop(F&& visit) {
  for (const Entry& entry : entries()) {
    const Form& form = entry.forms.front();
    const std::size_t rows = entry.one_by_one ? kSlowRows : kRows;
    const Columns inputs = entry.one_by_one ? usual_inputs(form) : drawn_inputs(entry, form, rows, 5);
    const Columns features = features_of(entry, form, inputs);
    const auto visit_both = [&](const char* what, const Loops<float>& loops) {
      SCOPED_TRACE(std::string(entry.name) + ", " + what);
      visit(entry, features, rows, loops.from_features);
      visit(entry, inputs, rows, loops.from_inputs);
    };
    visit_both("floats", entry.in_float);
    if (!entry.one_by_one) visit_both("batches", entry.in_batches);
  }
}

// Whatever lane a row falls into: 4 ulp, because the reduction of large angles depends on the other lanes of a batch.
TEST(EveryLoop, GivesTheSameRowsForAnyCountAndWritesNoFurther) {
  for_each_loop([](const Entry& entry, const Columns& columns, std::size_t rows, Loop<float> loop) {
    const auto in = columns_of(columns);
    const Columns whole = results_of(entry, loop, in, rows);
    EXPECT_TRUE(guards_hold(whole, rows));
    for (const std::size_t count : {0, 1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 17, 31, 33}) {
      if (count >= rows) break;
      const Columns part = results_of(entry, loop, in, count);
      EXPECT_TRUE(guards_hold(part, count)) << count << " rows";
      for (std::size_t k = 0; k < part.size(); ++k)
        for (std::size_t i = 0; i < count; ++i)
          ASSERT_LE(ulps_between(part[k][i], whole[k][i]), 4)
              << "row " << i << " of " << count << ", output " << k << ", at" << row_text(columns, i);
    }
  });
}

TEST(EveryLoop, TakesAColumnThatHoldsOneValueForAllRows) {
  for_each_loop([](const Entry& entry, const Columns& columns, std::size_t rows, Loop<float> loop) {
    // All of them together, and each alone where that is cheap.
    for (std::size_t constant = entry.one_by_one ? columns.size() : 0; constant <= columns.size(); ++constant) {
      Columns filled = columns;
      auto in = columns_of(columns);
      for (std::size_t k = 0; k < columns.size(); ++k) {
        if (constant != k && constant != columns.size()) continue;
        filled[k].assign(rows, columns[k][1]);
        in[k] = {&columns[k][1], true};
      }
      const Columns want = results_of(entry, loop, columns_of(filled), rows), got = results_of(entry, loop, in, rows);
      for (std::size_t k = 0; k < want.size(); ++k)
        for (std::size_t i = 0; i < rows; ++i)
          ASSERT_EQ(std::bit_cast<std::uint32_t>(got[k][i]), std::bit_cast<std::uint32_t>(want[k][i]))
              << "input " << constant << " constant, row " << i;
    }
  });
}

}  // namespace
}  // namespace likeness::catalog
