#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "brdf/cost/accuracy.h"

// How far values are from their reference, against numbers computed by hand.
namespace likeness::cost {
namespace {

// Four draws of (x, weight).
Draws four_draws() { return {4, {1, 1, 2, 1, 3, 0.5, 4, 0}}; }

Family family_of_two() {
  Family family;
  family.draw_names = {"x", "w"};
  family.negligible = 0;
  return family;
}

TEST(Accuracy, IsZeroForTheReferenceItself) {
  const std::vector<double> values{1, 2, 3, 4};
  Family family = family_of_two();
  family.energy_weight = [](const double*) { return 1.0; };
  const Accuracy a = accuracy_of(family, four_draws(), values, values);
  EXPECT_EQ(a.rms, 0);
  EXPECT_EQ(a.worst, 0);
  EXPECT_EQ(a.energy, 0);
}

TEST(Accuracy, RmsIsOfTheDifferenceOverThatOfTheReference) {
  const Accuracy a = accuracy_of(family_of_two(), four_draws(), {1, 2, 3, 7}, {1, 2, 2, 4});
  EXPECT_DOUBLE_EQ(a.rms, std::sqrt((1.0 + 9.0) / (1.0 + 4.0 + 4.0 + 16.0)));
}

TEST(Accuracy, WorstIsTheLargestRelativeDifferenceAndSaysWhere) {
  const Accuracy a = accuracy_of(family_of_two(), four_draws(), {1, 2, 3, 5}, {1, 2, 2, 4});
  EXPECT_DOUBLE_EQ(a.worst, 0.5);
  EXPECT_EQ(a.where, "x = 3, w = 0.5");
}

TEST(Accuracy, SmallValuesCountAsAShareOfTheRms) {
  Family family = family_of_two();
  family.negligible = 0.1;
  const double last = std::sqrt(50 - 0.0001);
  // The RMS of the reference is 5; the second value, 0.01, counts as 0.5.
  const Accuracy a = accuracy_of(family, four_draws(), {5, 0.11, 5, last}, {5, 0.01, 5, last});
  EXPECT_NEAR(a.worst, 0.2, 1e-12);
  EXPECT_EQ(a.where, "x = 2, w = 1");
}

TEST(Accuracy, WeightsMultiplyWhatIsCompared) {
  Family family = family_of_two();
  family.value_weight = [](const double* draw) { return draw[1]; };
  // The last draw has the weight 0, and would be the worst. The third counts half.
  const Accuracy a = accuracy_of(family, four_draws(), {1, 2, 4, 100}, {1, 2, 2, 1});
  EXPECT_DOUBLE_EQ(a.rms, std::sqrt(1.0 / (1 + 4 + 1)));
  EXPECT_DOUBLE_EQ(a.worst, 1);
  EXPECT_EQ(a.where, "x = 3, w = 0.5");
}

TEST(Accuracy, EnergyIsThatOfTheWorstBinAndLeavesOutWeightsOfZero) {
  Family family = family_of_two();
  family.energy_weight = [](const double* draw) { return draw[1]; };
  family.energy_bins = 2;
  family.energy_bin = [](const double* draw) { return std::size_t(draw[0] > 2.5); };
  // Bin 0: (1.1 + 2) / 3, bin 1: 0.5 x 1.5 over 0.5 x 2; the last draw has no weight.
  const Accuracy a = accuracy_of(family, four_draws(), {1.1, 2, 1.5, 100}, {1, 2, 2, 1});
  EXPECT_DOUBLE_EQ(a.energy, -0.25);
  family.energy_bins = 1, family.energy_bin = {};
  EXPECT_NEAR(accuracy_of(family, four_draws(), {1.1, 2, 1.5, 100}, {1, 2, 2, 1}).energy, (3.1 + 0.75) / 4 - 1, 1e-15);
}

TEST(Accuracy, WithoutAnEnergyThereIsNone) {
  EXPECT_TRUE(std::isnan(accuracy_of(family_of_two(), four_draws(), {1, 1, 1, 1}, {1, 1, 1, 1}).energy));
}

TEST(Accuracy, ANumberThatIsNoneIsTheWorst) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Accuracy a = accuracy_of(family_of_two(), four_draws(), {1, nan, 3, 4}, {1, 2, 3, 4});
  EXPECT_TRUE(std::isnan(a.rms));
  EXPECT_TRUE(std::isnan(a.worst));
  EXPECT_EQ(a.where, "x = 2, w = 1");
}

TEST(Draws, AreTheSameEveryTimeAndWithinWhatTheirFamilySays) {
  for (const Family& family : families()) {
    const Draws a = draws_of(family, 200), b = draws_of(family, 200);
    EXPECT_EQ(a.rows, b.rows) << family.name;
    EXPECT_EQ(a.rows.size(), 200 * family.draw_names.size());
    for (const double x : a.rows) EXPECT_TRUE(std::isfinite(x)) << family.name;
  }
}

TEST(Draws, OfTheDiffuseFamilyHaveTheDensityOfTheCosine) {
  const Family family = diffuse_family();
  const Draws draws = draws_of(family, 20000);
  double sum = 0;
  for (std::size_t i = 0; i < draws.count; ++i) sum += draws.rows[i * 7 + 3];
  // The mean of the cosine is 2/3, its deviation sqrt(1/18); five standard errors.
  EXPECT_NEAR(sum / 20000, 2.0 / 3, 5 * std::sqrt(1.0 / 18 / 20000));
}

}  // namespace
}  // namespace likeness::cost
