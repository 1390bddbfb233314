#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

// Pearson's test that counts were drawn from given expectations.
//
//     const ChiSquare test = chi_square(counts, expected);
//     EXPECT_GE(test.p, sidak(0.01, tests_in_the_suite)) << test.statistic;
namespace likeness::brdf {

// Q(a, x) = Gamma(a, x) / Gamma(a) for a > 0 and x >= 0: the series of the lower function below a + 1, the continued
// fraction of the upper one above (NIST Digital Library of Mathematical Functions, sections 8.7 and 8.9; the fraction
// evaluated forwards by Lentz's method). Relative error below 1e-12 for a up to 1e5 where Q > 1e-300.
inline double upper_gamma_ratio(double a, double x) {
  if (x <= 0) return 1;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (double n = a + 1; term > sum * 1e-17; ++n) sum += term *= x / n;
    return 1 - front * sum;
  }
  constexpr double kLeast = 1e-300;
  double b = x + 1 - a, c = 1 / kLeast, d = 1 / b, fraction = d;
  for (double i = 1; i < 1e6; ++i) {
    const double numerator = -i * (i - a);
    b += 2;
    d = numerator * d + b;
    c = b + numerator / c;
    if (std::abs(d) < kLeast) d = kLeast;
    if (std::abs(c) < kLeast) c = kLeast;
    d = 1 / d;
    fraction *= d * c;
    if (std::abs(d * c - 1) < 1e-16) break;
  }
  return front * fraction;
}

struct ChiSquare {
  double statistic = 0;
  std::size_t freedom = 0;  // degrees of it: bins after pooling, less one
  double p = 1;             // of a statistic at least as large, if the expectations are right
};

// Counts against expectations whose sums are equal. The bins of the smallest expectation are pooled until what they
// hold together is at least `least`, where the statistic's distribution is near enough to its limit. A count where
// nothing at all can be has p = 0.
inline ChiSquare chi_square(const std::vector<double>& counts, const std::vector<double>& expected, double least = 5) {
  std::vector<std::size_t> order(expected.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) { return expected[i] < expected[k]; });

  ChiSquare test;
  double pooled_expected = 0, pooled_count = 0;
  std::size_t bins = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const std::size_t i = order[rank];
    if (expected[i] <= 0 && counts[i] > 0) return {std::numeric_limits<double>::infinity(), 1, 0};
    pooled_expected += std::max(expected[i], 0.0);
    pooled_count += counts[i];
    if (pooled_expected < least && rank + 1 < order.size()) continue;
    if (pooled_expected <= 0) continue;
    const double excess = pooled_count - pooled_expected;
    test.statistic += excess * excess / pooled_expected;
    ++bins;
    pooled_expected = pooled_count = 0;
  }
  if (bins < 2) return test;
  test.freedom = bins - 1;
  test.p = upper_gamma_ratio(0.5 * double(test.freedom), 0.5 * test.statistic);
  return test;
}

// What p each of `tests` independent tests may fall to, if all together are to fail by chance with the probability
// `significance` only: 1 - (1 - significance)^(1 / tests).
inline double sidak(double significance, std::size_t tests) {
  return -std::expm1(std::log1p(-significance) / double(tests));
}

}  // namespace likeness::brdf
