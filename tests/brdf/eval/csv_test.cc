#include "brdf/eval/csv.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace likeness::eval {
namespace {

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  for (bool last = false; !last;) {
    const auto cell = take_cell(line, last);
    if (!cell) return {"unclosed"};
    cells.emplace_back(*cell);
  }
  return cells;
}

using Cells = std::vector<std::string>;

TEST(Csv, CellsLoseTheirBlanksAndQuotes) {
  EXPECT_EQ(cells_of("a,b,c"), (Cells{"a", "b", "c"}));
  EXPECT_EQ(cells_of(" a ,\tb\t, \"c\" ,\" d \"\r"), (Cells{"a", "b", "c", "d"}));
  EXPECT_EQ(cells_of("a,,b,"), (Cells{"a", "", "b", ""}));
  EXPECT_EQ(cells_of("\"a,b\",c"), (Cells{"a,b", "c"}));
  EXPECT_EQ(cells_of(""), (Cells{""}));
}

TEST(Csv, AQuoteThatIsNotClosedIsNoCell) {
  EXPECT_EQ(cells_of("\"a,b"), (Cells{"unclosed"}));
  EXPECT_EQ(cells_of("\"a\"b,c"), (Cells{"unclosed"}));
}

TEST(Csv, LinesEndWithANewlineOrWithTheText) {
  std::string_view text = "a\nb\r\n\nc";
  EXPECT_EQ(take_line(text), "a");
  EXPECT_EQ(take_line(text), "b\r");
  EXPECT_EQ(take_line(text), "");
  EXPECT_EQ(take_line(text), "c");
  EXPECT_TRUE(text.empty());
}

TEST(Csv, NumbersAreReadAsTheyAreWritten) {
  EXPECT_EQ(number_in("0.1"), 0.1);
  EXPECT_EQ(number_in("+1e3"), 1000);
  EXPECT_EQ(number_in("-.5E-2"), -0.005);
  EXPECT_EQ(number_in("inf"), HUGE_VAL);
  EXPECT_EQ(number_in("-INF"), -HUGE_VAL);
  EXPECT_TRUE(std::isnan(number_in("NaN").value_or(0)));
  EXPECT_EQ(number_in("1e400"), HUGE_VAL);
  EXPECT_EQ(number_in("-1e400"), -HUGE_VAL);
  EXPECT_EQ(number_in("1e-400"), 0);
  EXPECT_TRUE(std::signbit(number_in("-1e-400").value_or(1)));
  EXPECT_EQ(number_in("4.9e-324"), std::numeric_limits<double>::denorm_min());
}

TEST(Csv, WhatIsNoNumberIsNone) {
  for (const std::string_view text : {"", "x", "1x", "1 2", "0x10", "1,5", "--1", "+-1", "+", "-", ".", "1e", "½"})
    EXPECT_FALSE(number_in(text)) << text;
}

TEST(Csv, ALineOfNumbersStopsAtTheFirstThatIsNone) {
  std::array<double, 3> out{};
  Numbers found = read_numbers("1, 2 ,\"3\"", out);
  EXPECT_EQ(found.cells, 3u);
  EXPECT_FALSE(found.wrong);
  EXPECT_EQ(out, (std::array<double, 3>{1, 2, 3}));
  found = read_numbers("1,two,3", out);
  EXPECT_EQ(found.cells, 1u);
  EXPECT_EQ(found.wrong, "two");
  found = read_numbers("1,2,3,4,5", out);
  EXPECT_EQ(found.cells, 5u) << "there is room for three only";
  found = read_numbers("1,2,", out);
  EXPECT_EQ(found.cells, 2u);
  EXPECT_EQ(found.wrong, "");
  found = read_numbers("1,\"2,3", out);
  EXPECT_EQ(found.cells, 1u);
  EXPECT_TRUE(found.wrong);
}

TEST(Csv, SeventeenDigitsReadBackAsTheSameNumber) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 10000; ++i) {
    const double value = std::ldexp(double(random()) * 0x1p-64 - 0.5, int(random() % 2000) - 1000);
    std::string text;
    append_number(text, value);
    EXPECT_EQ(number_in(text), value) << text;
    EXPECT_LE(text.size(), 24u);
  }
  std::string text;
  append_number(text, 0.1);
  EXPECT_EQ(text, "0.10000000000000001");
  text.clear();
  append_number(text, -std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(text, "nan");
}

}  // namespace
}  // namespace likeness::eval
