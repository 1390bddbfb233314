#include <gtest/gtest.h>

#include <algorithm>

#include "tests/brdf/catalog/drawn_rows.h"

// The instruction sets agree: what a renderer shows and what a fit was done with do not depend on the machine.
namespace likeness::catalog {
namespace {

constexpr std::int64_t kUlps = 4;
constexpr std::size_t kParityRows = 16 * 1024;

struct Worst {
  std::int64_t ulps = 0;
  std::size_t unequal = 0, row = 0, output = 0;
  float want = 0, got = 0;
};
Worst worst_of(const Columns& want, const Columns& got) {
  Worst worst;
  for (std::size_t k = 0; k < want.size(); ++k)
    for (std::size_t i = 0; i < kParityRows; ++i) {
      const std::int64_t ulps = ulps_between(got[k][i], want[k][i]);
      worst.unequal += ulps != 0;
      if (ulps > worst.ulps) worst = {ulps, worst.unequal, i, k, want[k][i], got[k][i]};
    }
  return worst;
}

class EveryEvaluator : public ::testing::TestWithParam<std::string_view> {};  // the set that is held against baseline

TEST_P(EveryEvaluator, AgreesWithTheBaselineToFourUlps) {
  const auto sets = instruction_sets();
  if (std::find(sets.begin(), sets.end(), GetParam()) == sets.end())
    GTEST_SKIP() << "this processor (or this build) has no " << GetParam();
  std::size_t compared = 0, equal = 0;
  for (const Entry& entry : entries()) {
    if (entry.one_by_one) continue;
    const Loops<float> base = loops_in("baseline", entry.name), wide = loops_in(GetParam(), entry.name);
    ASSERT_TRUE(base.from_features && wide.from_features) << entry.name;
    for (std::size_t f = 0; f < entry.forms.size(); ++f) {
      const Form& form = entry.forms[f];
      const Columns inputs = drawn_inputs(entry, form, kParityRows, 13 + f),
                    features = features_of(entry, form, inputs);
      const auto compare = [&](const char* from, const Columns& columns, Loop<float> with, Loop<float> without) {
        const auto in = columns_of(columns);
        const Worst worst =
            worst_of(results_of(entry, without, in, kParityRows), results_of(entry, with, in, kParityRows));
        compared += kParityRows * entry.output_count;
        equal += kParityRows * entry.output_count - worst.unequal;
        EXPECT_LE(worst.ulps, kUlps) << entry.name << " from " << from << ": output " << worst.output << " is "
                                     << worst.got << " with " << GetParam() << ", " << worst.want << " without, at"
                                     << row_text(columns, worst.row) << "; " << worst.unequal << " of "
                                     << kParityRows * entry.output_count << " values differ";
      };
      compare("features", features, wide.from_features, base.from_features);
      if (f == 0) compare("inputs", inputs, wide.from_inputs, base.from_inputs);
    }
  }
  RecordProperty("values_compared", std::to_string(compared));
  RecordProperty("values_equal_to_the_bit", std::to_string(equal));
  EXPECT_GT(compared, 0u);
}
INSTANTIATE_TEST_SUITE_P(Sets, EveryEvaluator, ::testing::Values("avx2", "avx512"),
                         [](const auto& set) { return std::string(set.param); });

}  // namespace
}  // namespace likeness::catalog
