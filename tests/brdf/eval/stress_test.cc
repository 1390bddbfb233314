#include "brdf/eval/stress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/brdf/eval/toy_evaluators.h"

namespace likeness::eval {
namespace {

using catalog::Column;
using catalog::Entry;

Stressed run(const Entry& entry, std::uint64_t rows = 20000) {
  return stress(entry, {.rows = rows, .seed = 7}, nullptr);
}

TEST(Stress, AnExactEvaluatorHasNoErrorButItsRounding) {
  const Stressed result = run(test::toy());
  ASSERT_EQ(result.precisions.size(), 3u);
  EXPECT_EQ(result.precisions[0].precision, "double");
  EXPECT_EQ(result.precisions[2].precision, "batch");
  // f = cos color is negative below the horizon: light_z is in [-1, 1] and the toy does not mind.
  EXPECT_GT(result.precisions[0].negative, 0u);
  for (const Swept& s : result.precisions) {
    EXPECT_EQ(s.not_finite, 0u);
    EXPECT_LE(s.worst.value, 6e-8) << s.precision;  // one rounding of a product
    EXPECT_EQ(s.over, 0u);
    EXPECT_TRUE(s.ulps.inputs.empty());
    EXPECT_GT(s.seconds, 0);
  }
  EXPECT_EQ(result.rows, 20000u);
}

TEST(Stress, NegativeIsAllowedWhereTheOutputSaysSo) {
  Entry entry = test::toy();
  entry.forms.erase(entry.forms.begin());  // the angles: cos_i within [0, 1], so only g is negative, and may be
  entry.in_double.from_inputs = &test::Toy::loop<double>;
  entry.in_float.from_inputs = entry.in_batches.from_inputs = &test::Toy::loop<float>;
  EXPECT_TRUE(run(entry).sound());
  static constexpr std::array kOutputs{brdf::Output{.name = "f", .channels = 3, .text = "f"},
                                       brdf::Output{.name = "g", .text = "-x"}};
  entry.outputs = kOutputs;
  const Stressed result = run(entry);
  EXPECT_FALSE(result.sound());
  EXPECT_GT(result.precisions[1].negative, 10000u);
  EXPECT_EQ(result.precisions[1].bad.output, "g");
  EXPECT_EQ(result.precisions[1].bad.inputs.size(), 5u);
}

// A NaN at one value of one input, in batches alone.
TEST(Stress, FindsANaNAtAnEdge) {
  Entry entry = test::toy();
  entry.forms.erase(entry.forms.begin());  // the angles: nothing is negative that may not be
  entry.in_double.from_inputs = &test::Toy::loop<double>;
  entry.in_float.from_inputs = &test::Toy::loop<float>;
  entry.in_batches.from_inputs = [](const void*, const Column<float>* in, float* const* out, std::size_t n) {
    test::Toy::loop<float>(nullptr, in, out, n);
    for (std::size_t i = 0; i < n; ++i)
      if (in[4].data[i] == 10) out[3][i] = std::numeric_limits<float>::quiet_NaN();
  };
  const Stressed result = run(entry);
  EXPECT_FALSE(result.sound());
  EXPECT_EQ(result.precisions[1].not_finite, 0u);
  EXPECT_GT(result.precisions[2].not_finite, 10u);
  EXPECT_EQ(result.precisions[2].bad.output, "g");
  EXPECT_EQ(result.precisions[2].bad.inputs.at(4), 10);
}

// An error of 1e-4 is found, with the row where it is, and is no matter of rounded inputs.
TEST(Stress, FindsAnErrorAndWhereItIs) {
  Entry entry = test::toy();
  entry.in_float.from_inputs = [](const void*, const Column<float>* in, float* const* out, std::size_t n) {
    test::Toy::loop_from_vectors<float>(nullptr, in, out, n);
    for (std::size_t i = 0; i < n; ++i)
      if (in[6].data[i] > 9) out[3][i] *= 1 + 1e-4f;
  };
  const Swept swept = run(entry).precisions[1];
  EXPECT_NEAR(swept.worst.value, 1e-4, 1e-6);
  EXPECT_GT(swept.worst.inputs[6], 9);
  EXPECT_EQ(swept.worst.output, "g");
  EXPECT_GT(swept.over, 1000u);
  EXPECT_LT(swept.over, 10000u);
  EXPECT_NEAR(swept.quantile(0.999), 1e-4, 2e-5);
  EXPECT_LT(swept.quantile(0.5), 1e-7);
  // 1e-4 of x, against an ulp of x (1.2e-7 x at most) and half an ulp of the result.
  EXPECT_GT(swept.ulps.value, 500);
  EXPECT_LT(swept.ulps.value, 1700);
}

// The result is small because two inputs cancel: its error is large, but one ulp of an input does as much.
TEST(Stress, AnErrorThatRoundedInputsExplainIsSmallInTheirUnits) {
  static constexpr std::array kOneInput{
      brdf::Parameter{.name = "a", .initial = 1, .range = {1, 2}, .typical = {1, 2}, .text = "a"}};
  static constexpr std::array kOutputs{brdf::Output{.name = "s", .may_be_negative = true, .text = "sin(1000 a)"}};
  Entry entry = test::toy();
  entry.forms = {{kOneInput, 1, nullptr}};
  entry.outputs = kOutputs;
  entry.output_count = entry.features = 1;
  entry.in_double.from_inputs = [](const void*, const Column<double>* in, double* const* out, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) out[0][i] = std::sin(1000 * in[0].data[i]);
  };
  entry.in_float.from_inputs = [](const void*, const Column<float>* in, float* const* out, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) out[0][i] = std::sin(1000 * in[0].data[i]);
  };
  entry.one_by_one = true;
  const Stressed result = run(entry);
  ASSERT_EQ(result.precisions.size(), 2u) << "no batches of what is evaluated one by one";
  EXPECT_GT(result.precisions[1].worst.value, 1e-3);
  EXPECT_TRUE(result.precisions[1].ulps.inputs.empty()) << result.precisions[1].ulps.value;
}

// Where denominators are kept from 0 in float and not yet in double: the row is checked and not compared.
TEST(Stress, RowsWithAVanishingInputAreNotCompared) {
  Entry entry = test::toy();
  entry.in_float.from_inputs = [](const void*, const Column<float>* in, float* const* out, std::size_t n) {
    test::Toy::loop_from_vectors<float>(nullptr, in, out, n);
    for (std::size_t i = 0; i < n; ++i)
      if (in[6].data[i] > 0 && in[6].data[i] < 1e-9f) out[3][i] = 1;
  };
  const Swept swept = run(entry).precisions[1];
  EXPECT_LE(swept.worst.value, 6e-8);
  EXPECT_LT(swept.compared, 20000u);
  EXPECT_GT(swept.compared, 5000u);
}

TEST(Stress, TheSameSeedGivesTheSameResult) {
  Entry entry = test::toy();
  entry.in_float.from_inputs = [](const void*, const Column<float>* in, float* const* out, std::size_t n) {
    test::Toy::loop_from_vectors<float>(nullptr, in, out, n);
    for (std::size_t i = 0; i < n; ++i) out[3][i] = std::sqrt(out[3][i] * out[3][i]) * -1.00001f;
  };
  const Stressed a = run(entry, 50000), b = run(entry, 50000);
  EXPECT_EQ(a.precisions[1].worst.inputs, b.precisions[1].worst.inputs);
  EXPECT_EQ(a.precisions[1].histogram, b.precisions[1].histogram);
  EXPECT_EQ(a.precisions[1].ulps.inputs, b.precisions[1].ulps.inputs);
}

TEST(Stress, ASlowEvaluatorGetsFewerRows) {
  Entry entry = test::toy();
  entry.in_double.from_inputs = [](const void*, const Column<double>* in, double* const* out, std::size_t n) {
    test::Toy::loop_from_vectors<double>(nullptr, in, out, n);
    volatile double burn = 0;
    for (std::size_t i = 0; i < n * 20000; ++i) burn = burn + 1;  // some 20 us a row
  };
  const Stressed result = run(entry, 100000);
  EXPECT_LE(result.rows, 50000u);
  EXPECT_GE(result.rows, 2u);
  std::uint64_t counted = 0;
  for (const std::uint64_t count : result.precisions[1].histogram) counted += count;
  EXPECT_EQ(counted, result.precisions[1].compared);
  EXPECT_LE(counted, result.rows);
}

TEST(Stress, ReportsAreTablesOfWhatWasFound) {
  const Entry entry = test::toy();  // the result names it
  const Stressed result = run(entry, 5000);
  const std::string text = stress_lines(result, false), markdown = stress_lines(result, true);
  EXPECT_THAT(text, testing::HasSubstr("bad: f = -"));
  EXPECT_THAT(text, testing::HasSubstr("light_x="));
  EXPECT_EQ(std::count(markdown.begin(), markdown.end(), '\n'), 3);
  const std::string header = stress_csv_header(), lines = stress_csv_lines(result);
  const auto commas = std::count(header.begin(), header.end(), ',');
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << line;
}

}  // namespace
}  // namespace likeness::eval
