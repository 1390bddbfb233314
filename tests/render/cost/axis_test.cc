#include <cmath>

#include <gtest/gtest.h>

#include "render/page/pareto_axis.h"

namespace likeness::page {
namespace {

TEST(Axis, HoldsAClusterWithoutABreak) {
  const Axis axis = axis_over({1, 10, 2}, false, 1.1, 0.1, 100, 400, 50);
  EXPECT_FALSE(axis.is_broken);
  EXPECT_DOUBLE_EQ(axis.low, -0.1);
  EXPECT_DOUBLE_EQ(axis.high, 1.1);
  EXPECT_DOUBLE_EQ(axis.at(std::pow(10.0, 0.5)), 250) << "the middle";
  EXPECT_NEAR(axis.at(std::pow(10.0, -0.1)), 100, 1e-9);
}

TEST(Axis, PutsFarSlowTimesBehindABreak) {
  const Axis axis = axis_over({1, 2, 1000, 4000}, false, 1.1, 0.1, 0, 400, 100);
  ASSERT_TRUE(axis.is_broken);
  EXPECT_FALSE(axis.in_strip(2));
  EXPECT_TRUE(axis.in_strip(1000));
  EXPECT_LT(axis.at(2), 300);
  EXPECT_DOUBLE_EQ(axis.to, 300);
  EXPECT_NEAR(axis.at(1000), 325, 1e-9) << "a quarter into the strip";
  EXPECT_NEAR(axis.at(4000), 375, 1e-9);
}

TEST(Axis, PutsErrorsFarBelowBehindABreakAndKeepsTheirOrder) {
  // Drawn upwards: from the bottom at 300 to the top at 0.
  const Axis axis = axis_over({0.5, 0.1, 1e-7, 1e-12}, true, 1.5, 0.1, 300, 0, 60);
  ASSERT_TRUE(axis.is_broken);
  EXPECT_DOUBLE_EQ(axis.from, 240);
  EXPECT_LT(axis.at(0.5), axis.at(0.1));
  EXPECT_LT(axis.at(0.1), 240);
  EXPECT_GT(axis.at(1e-7), 240);
  EXPECT_GT(axis.at(1e-12), axis.at(1e-7));
  EXPECT_LE(axis.at(1e-12), 300);
}

TEST(Axis, GivesASingleValueRoomAndTicks) {
  const Axis axis = axis_over({3}, false, 1.1, 0.1, 0, 100, 50);
  EXPECT_NEAR(axis.at(3), 50, 1e-9);
  EXPECT_GE(axis.ticks().size(), 2u);
  for (const auto& [value, place] : axis.ticks()) EXPECT_TRUE(place >= 0 && place <= 100) << value;
}

}  // namespace
}  // namespace likeness::page
