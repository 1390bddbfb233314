#include "brdf/eval/rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/files/files.h"
#include "tests/brdf/eval/toy_evaluators.h"

namespace likeness::eval {
namespace {

using testing::HasSubstr;

const catalog::Entry kToyEntry = test::toy();

Rows rows_of(std::string_view header, Precision precision = Precision::kDouble,
             const std::vector<Assignment>& assignments = {}) {
  return {kToyEntry, header, assignments, precision, "t.csv"};
}

std::string text_of(std::string_view header, std::string_view lines, Precision precision = Precision::kDouble) {
  const Rows rows = rows_of(header, precision);
  return rows.header() + rows.evaluate(lines, 2).text;
}

std::string refused(std::string_view header, std::string_view lines) {
  try {
    rows_of(header).evaluate(lines, 2);
  } catch (const files::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Rows, OutputsAreAppendedToTheCellsAsTheyWereWritten) {
  EXPECT_EQ(text_of("cos_i,x", " 0.50 ,+1e0\n\"1\",03\n"), "cos_i,x,f,g\n 0.50 ,+1e0,0.25,-1\n\"1\",03,0.5,-3\n");
}

TEST(Rows, TheOrderOfColumnsIsTheUsers) {
  EXPECT_EQ(text_of("x,color_b,cos_i,color_r,color_g", "1,0.25,1,0.5,0.75\n"),
            "x,color_b,cos_i,color_r,color_g,f_r,f_g,f_b,g\n1,0.25,1,0.5,0.75,0.5,0.75,0.25,-1\n");
}

TEST(Rows, LineEndingsAreKeptAndBlankLinesLeftOut) {
  EXPECT_EQ(text_of("cos_i,x\r", "1,2\r\n\r\n0,2\n  \n1,3"), "cos_i,x,f,g\r\n1,2,0.5,-2\r\n0,2,0,-2\n1,3,0.5,-3\n");
}

TEST(Rows, QuotedNamesAreNames) { EXPECT_EQ(rows_of(" \"cos_i\" ,x").columns().inputs.size(), 2u); }

TEST(Rows, MoreRowsThanAChunkAreEvaluatedInOrder) {
  std::string lines;
  for (int i = 0; i < 1000; ++i) lines += std::to_string(i / 1000.0) + "\n";
  const Outcome outcome = rows_of("cos_i", Precision::kDouble, {{"color", {1}}}).evaluate(lines, 2);
  EXPECT_EQ(outcome.rows, 1000u);
  std::istringstream in(outcome.text);
  std::string line;
  for (int i = 0; std::getline(in, line); ++i) {
    const std::size_t first = line.find(','), second = line.find(',', first + 1);
    ASSERT_EQ(std::stod(line.substr(first + 1, second - first - 1)), std::stod(line.substr(0, first))) << i;
  }
}

TEST(Rows, FloatAndBatchRoundTheFeatures) {
  EXPECT_EQ(text_of("cos_i,x", "1,0.1\n", Precision::kFloat), "cos_i,x,f,g\n1,0.1,0.5,-0.10000000149011612\n");
  EXPECT_EQ(text_of("cos_i,x", "1,0.1\n", Precision::kBatch), "cos_i,x,f,g\n1,0.1,0.5,-0.10000000149011612\n");
  EXPECT_EQ(text_of("cos_i,x", "1,0.1\n"), "cos_i,x,f,g\n1,0.1,0.5,-0.10000000000000001\n");
}

TEST(Rows, ReferencesAreComparedAndTheWorstIsKept) {
  const Outcome outcome = rows_of("cos_i,ref_g,x,ref_f").evaluate("1,-2,2,0.5\n\n1,-4,2,0.5\n1,-2.5,2,0.25\n", 2);
  ASSERT_EQ(outcome.worst.size(), 2u);
  EXPECT_EQ(outcome.worst[0].difference, 0.5);  // |-2 + 4| / 4
  EXPECT_EQ(outcome.worst[0].row, 2u);
  EXPECT_EQ(outcome.worst[0].line, 4u);
  EXPECT_EQ(outcome.worst[1].difference, 0.5);
  EXPECT_EQ(outcome.worst[1].row, 3u);
}

TEST(Rows, EqualNumbersDoNotDifferWhateverTheyAre) {
  const Outcome outcome = rows_of("x,ref_g").evaluate("nan,nan\ninf,-inf\n0,0\n0,-0\n", 2);
  EXPECT_EQ(outcome.worst[0].difference, 0);
  EXPECT_EQ(outcome.worst[0].row, 0u);
  EXPECT_EQ(rows_of("x,ref_g").evaluate("nan,1\n", 2).worst[0].difference, HUGE_VAL);
  EXPECT_EQ(rows_of("x,ref_g").evaluate("inf,1\n", 2).worst[0].difference, HUGE_VAL);
}

TEST(Rows, WhatIsBelowTheNormalNumbersCountsAsEqual) {
  EXPECT_EQ(rows_of("x,ref_g", Precision::kFloat).evaluate("1e-39,-2e-39\n", 2).worst[0].difference, 0);
  EXPECT_EQ(rows_of("x,ref_g").evaluate("1e-39,-2e-39\n", 2).worst[0].difference, 0.5);
}

TEST(Rows, OutcomesAddUpToThatOfTheWhole) {
  const Rows rows = rows_of("cos_i,ref_g");
  const std::string first = "1,-2\n1,-2.5\n", second = "2,-2\n1,-4\n3,-2\n";
  Outcome sum;
  sum.add(rows.evaluate(first, 2));
  sum.add(rows.evaluate(second, 4));
  const Outcome whole = rows.evaluate(first + second, 2);
  EXPECT_EQ(sum.rows, whole.rows);
  EXPECT_EQ(sum.outside, whole.outside);
  EXPECT_EQ(sum.outside_line, whole.outside_line);
  EXPECT_EQ(sum.first_outside, whole.first_outside);
  EXPECT_EQ(sum.worst[0].row, whole.worst[0].row);
  EXPECT_EQ(sum.worst[0].line, whole.worst[0].line);
  EXPECT_EQ(whole.worst[0].row, 4u);
}

TEST(Rows, InputsOutsideTheirRangeAreComputedAndCounted) {
  const Outcome outcome = rows_of("cos_i,x").evaluate("1,2\n1,11\n2,-1\nnan,1\n1,10.000001\n", 2);
  EXPECT_EQ(outcome.rows, 5u);
  EXPECT_EQ(outcome.outside, 3u);
  EXPECT_EQ(outcome.outside_line, 3u);
  EXPECT_EQ(outcome.first_outside, "x = 11 is outside [0, 10]");
}

TEST(Rows, ADirectionThatIsNotUnitIsRefusedWithItsLength) {
  EXPECT_EQ(refused("light_x,light_y,light_z", "0.6,0,0.8\n0,0.6,0.8000005\n"), "accepted");
  const std::string said = refused("light_x,light_y,light_z", "0.6,0,0.8\n0.6,0,0.6\n");
  EXPECT_THAT(said, HasSubstr("t.csv:3: (light_x, light_y, light_z) = (0.6, 0, 0.6) has the length 0.848"));
  EXPECT_THAT(refused("light_x", "nan\n"), HasSubstr("t.csv:2"));
  EXPECT_THAT(refused("light_x", "0.5\n"), HasSubstr("has the length 1.11")) << "with the default of light_z";
}

TEST(Rows, ARowThatIsNoneIsRefusedWithItsLine) {
  EXPECT_THAT(refused("cos_i,x", "1,2\n1\n"), HasSubstr("t.csv:3: 1 values; expected 2, as the header has"));
  EXPECT_THAT(refused("cos_i,x", "1,2,3\n"), HasSubstr("t.csv:2: more than 2 values; expected 2"));
  EXPECT_THAT(refused("cos_i,x", "1,2,junk\n"), HasSubstr("t.csv:2: more than 2 values; expected 2"));
  EXPECT_THAT(refused("cos_i,x", "1,two\n"), HasSubstr("t.csv:2: column x holds \"two\"; expected a number"));
  EXPECT_THAT(refused("cos_i,x", "1,\n"), HasSubstr("t.csv:2: column x holds nothing; leave the whole column out"));
  EXPECT_THAT(refused("cos_i,x", "1,\"2\n"), HasSubstr("t.csv:2: column x holds"));
}

TEST(Rows, AHeaderWithAnOpenQuoteIsRefused) { EXPECT_THROW(rows_of("cos_i,\"x"), files::InputError); }

// An evaluator whose channels differ although its inputs are grey: what one column leaves out is counted.
TEST(Rows, ChannelsThatDifferInOneColumnAreCounted) {
  catalog::Entry rainbow = test::toy();
  rainbow.in_double.from_features = [](const void*, const catalog::Column<double>*, double* const* out, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
      for (int k = 0; k < 4; ++k) out[k][i] = k;
  };
  const Rows rows(rainbow, "cos_i", {}, Precision::kDouble, "t.csv");
  EXPECT_EQ(rows.evaluate("1\n0\n", 2).colored, 2u);
}

}  // namespace
}  // namespace likeness::eval
