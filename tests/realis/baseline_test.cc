#include "realis/baseline/baseline.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/realis/domes.h"

namespace likeness::realis {
namespace {

double foretold(Relighter relighter, const std::vector<glm::dvec3>& lights, const glm::dvec3& direction,
                const auto& photo) {
  const std::vector<double> weights = Baseline(relighter, lights).weights(direction);
  double sum = 0;
  for (std::size_t i = 0; i < lights.size(); ++i) sum += weights[i] * photo(lights[i]);
  return sum;
}

// Each sum of its own terms comes back at directions that were not among the lights, to the rounding of a system whose
// condition is below 1e5.
TEST(Baseline, OfTermsGivesBackEverySumOfItsTerms) {
  const std::vector<glm::dvec3> lights = test::dome(40), others = test::dome(17);
  for (const RelighterRow& row : kRelighters) {
    if (row.terms == 0) continue;
    const auto photo = [&](const glm::dvec3& d) {
      double sum = 0, factor = 1;
      for (const double term : terms_of(row.relighter, d)) sum += factor * term, factor = -0.8 * factor + 0.3;
      return sum;
    };
    ASSERT_EQ(terms_of(row.relighter, {0, 0, 1}).size(), row.terms);
    for (const glm::dvec3& d : others)
      EXPECT_NEAR(foretold(row.relighter, lights, d, photo), photo(d), 1e-9) << row.name;
  }
}

TEST(Baseline, OfPhotographsGivesBackPlanesAndEveryPhotograph) {
  const std::vector<glm::dvec3> lights = test::dome(40);
  const auto plane = [](const glm::dvec3& d) { return 0.4 + 0.3 * d.x - 0.2 * d.y; };
  const auto wavy = [](const glm::dvec3& d) { return std::sin(7 * d.x) + std::cos(9 * d.y); };
  for (const RelighterRow& row : kRelighters) {
    if (row.terms != 0) continue;
    EXPECT_NEAR(foretold(row.relighter, lights, {0.1, 0.2, std::sqrt(0.95)}, plane), plane({0.1, 0.2, 0}), 1e-9)
        << row.name;
    for (const glm::dvec3& d : lights) EXPECT_NEAR(foretold(row.relighter, lights, d, wavy), wavy(d), 1e-8) << row.name;
  }
}

// The integral of H_i H_j over the half sphere, by the middle of 200 x 400 cells: an error of about 1e-4.
TEST(Baseline, HemisphericalHarmonicsAreOrthonormal) {
  constexpr int kRows = 200, kColumns = 400;
  std::vector<double> gram(256, 0.0);
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c) {
      const double z = (r + 0.5) / kRows, phi = (c + 0.5) / kColumns * 2 * std::numbers::pi, s = std::sqrt(1 - z * z);
      const std::vector<double> h = terms_of(Relighter::kHsh16, {s * std::cos(phi), s * std::sin(phi), z});
      for (std::size_t i = 0; i < 16; ++i)
        for (std::size_t j = 0; j < 16; ++j)
          gram[16 * i + j] += h[i] * h[j] * 2 * std::numbers::pi / (kRows * kColumns);
    }
  for (std::size_t i = 0; i < 16; ++i)
    for (std::size_t j = 0; j < 16; ++j) EXPECT_NEAR(gram[16 * i + j], i == j ? 1 : 0, 1e-3) << i << " " << j;
}

TEST(Baseline, BarycentricWeightsAreThoseOfATriangleOrOfTheNearestEdge) {
  const auto at = [](double x, double y) { return glm::dvec3(x, y, std::sqrt(1 - x * x - y * y)); };
  // Four corners of a square, which lie on one circle, and a light in the middle.
  const std::vector<glm::dvec3> lights{at(0.5, 0.5), at(-0.5, 0.5), at(-0.5, -0.5), at(0.5, -0.5), at(0, 0)};
  const Baseline baseline(Relighter::kBarycentric, lights);
  const std::vector<double> inside = baseline.weights(at(0.2, 0)), outside = baseline.weights(at(0.9, 0));
  EXPECT_NEAR(inside[0], 0.2, 1e-12);
  EXPECT_NEAR(inside[3], 0.2, 1e-12);
  EXPECT_NEAR(inside[4], 0.6, 1e-12);
  EXPECT_NEAR(outside[0], 0.5, 1e-12);
  EXPECT_NEAR(outside[3], 0.5, 1e-12);
}

TEST(Baseline, IsFiniteForOneLightOneLineOfLightsAndTheSameLightTwice) {
  const std::vector<std::vector<glm::dvec3>> cases{
      {{0, 0, 1}}, {{0, 0, 1}, {0, 0, 1}}, {{-0.6, 0, 0.8}, {0, 0, 1}, {0.6, 0, 0.8}, {0.6, 0, 0.8}}};
  for (const RelighterRow& row : kRelighters)
    for (const std::vector<glm::dvec3>& lights : cases)
      for (const glm::dvec3& d : {glm::dvec3(0, 0, 1), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1)})
        for (const double w : Baseline(row.relighter, lights).weights(d)) {
          EXPECT_TRUE(std::isfinite(w)) << row.name;
          EXPECT_LT(std::abs(w), 100) << row.name;
        }
}

TEST(Baseline, SaysItsBytes) {
  EXPECT_EQ(bytes_of(kRelighters[0], 96, false), 18u);
  EXPECT_EQ(bytes_of(kRelighters[0], 96, true), 9u);
  EXPECT_EQ(bytes_of(kRelighters[4], 96, false), 48u);
  EXPECT_EQ(bytes_of(kRelighters[5], 96, false), 288u);
}

}  // namespace
}  // namespace likeness::realis
