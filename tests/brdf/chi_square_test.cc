#include "tests/brdf/chi_square.h"

#include <gtest/gtest.h>

#include "tests/brdf/evaluate.h"

// The test that others lean on.
namespace likeness::brdf {
namespace {

TEST(ChiSquare, UpperGammaRatioIsThatOfFortyDigits) {
  struct Known {
    double a, x, q;
  };
  for (const Known& k :
       {Known{0.5, 0.15, 0.58388242077036517}, Known{0.5, 1.5, 0.083264516663550402}, Known{1, 3, 0.049787068367863943},
        Known{10, 3, 0.99889751186988452}, Known{10, 10, 0.45792971447185221}, Known{10, 30, 7.1217508628155771e-6},
        Known{500, 500, 0.49405285382923964}, Known{500, 750, 1.0454640385979657e-22}})
    EXPECT_NEAR(upper_gamma_ratio(k.a, k.x) / k.q, 1, 1e-12) << k.a << " " << k.x;  // lgamma at 500: 2e-13
}

// Of 20000 throws of a die whose six comes up `six` times as often as another number.
double p_of_die(std::uint64_t seed, double six) {
  Random random(seed);
  constexpr int kThrows = 20000;
  std::vector<double> counts(6);
  for (int i = 0; i < kThrows; ++i) ++counts[std::size_t(std::min(random.uniform(0, 5 + six), 5.0))];
  return chi_square(counts, std::vector<double>(6, kThrows / 6.0)).p;
}
TEST(ChiSquare, OfTrueExpectationsIsEvenlySpread) {
  int low = 0, high = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const double p = p_of_die(seed, 1);
    low += p < 0.1;
    high += p > 0.9;
  }
  EXPECT_NEAR(low, 20, 16);  // 3.8 sigmas of a binomial
  EXPECT_NEAR(high, 20, 16);
}
TEST(ChiSquare, SeesALoadedDie) {
  EXPECT_LT(p_of_die(1, 1.15), 1e-6);  // 55 more of 3333 and less of the others expected: 8e-13 in the mean
}

TEST(ChiSquare, PoolsRareBinsAndKeepsTheSum) {
  const ChiSquare test = chi_square({10, 0, 1, 2, 3, 20}, {10, 1, 1, 2, 2, 20});
  EXPECT_EQ(test.freedom, 2u);  // 1 + 1 + 2 + 2, 10 and 20
  EXPECT_EQ(test.statistic, 0);
}
TEST(ChiSquare, ACountWhereNothingCanBeFails) {
  EXPECT_EQ(chi_square({10, 1}, {11, 0}).p, 0);
  EXPECT_EQ(chi_square({11, 0}, {11, 0}).p, 1);
}
TEST(ChiSquare, SidakKeepsTheSuiteAtItsSignificance) {
  EXPECT_NEAR(1 - std::pow(1 - sidak(0.01, 270), 270), 0.01, 1e-12);
  EXPECT_EQ(sidak(0.01, 1), 0.01);
}

}  // namespace
}  // namespace likeness::brdf
