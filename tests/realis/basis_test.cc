#include <cmath>
#include <set>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "realis/basis.h"
#include "tests/realis/domes.h"

namespace likeness::realis {
namespace {

TEST(Basis, SpreadsOutAsManyDifferentDirectionsAsAskedFor) {
  const std::vector<glm::dvec3> lights = test::dome(96);
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{13}, std::size_t{95}}) {
    const auto axes = spread_out(lights, count);
    ASSERT_EQ(axes.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_NEAR(glm::length(axes[i]), 1, 1e-12);
      for (std::size_t k = 0; k < i; ++k) EXPECT_LT(glm::dot(axes[i], axes[k]), 1 - 1e-6);
    }
  }
}

TEST(Basis, OfAllDirectionsIsThemselvesInTheirOrder) {
  const std::vector<glm::dvec3> lights = test::dome(20);
  EXPECT_EQ(spread_out(lights, 20), lights);
  EXPECT_EQ(spread_out(lights, 1000), lights);
}

TEST(Basis, CountsLightsAtOnePlaceOnce) {
  std::vector<glm::dvec3> lights = test::dome(5);
  lights.insert(lights.end(), lights.begin(), lights.end());
  EXPECT_EQ(spread_out(lights, 100).size(), 5u);
  EXPECT_EQ(spread_out(std::vector(7, glm::dvec3(0, 0, 1)), 3).size(), 1u);
}

TEST(Basis, OfNothingIsNothing) {
  EXPECT_TRUE(spread_out({}, 4).empty());
  EXPECT_TRUE(values(std::span<const Lobe>{}, test::dome(3)).empty());
}

// The farthest light from its axis stays near: centers cover the dome. Twelve caps of equal area on half a sphere have a
// radius of 24 degrees; centers that are only k-means' are granted half as much again.
TEST(Basis, CoversTheLights) {
  const std::vector<glm::dvec3> lights = test::dome(400);
  const auto axes = spread_out(lights, 12);
  for (const glm::dvec3& light : lights) {
    double best = -1;
    for (const glm::dvec3& axis : axes) best = std::max(best, glm::dot(light, axis));
    EXPECT_GT(best, std::cos(36 * 3.14159265358979 / 180));
  }
}

TEST(Basis, LobesAreOneOnTheirAxisAndEndWhereTheGaussianFallsToAHundredth) {
  const std::vector<Lobe> lobes{{{0, 0, 1}, 20}, {{1, 0, 0}, 0}};
  const double end = std::acos(1 - std::log(100.0) / 20);
  const std::vector<glm::dvec3> towards{
      {0, 0, 1}, {std::sin(end), 0, std::cos(end)}, {0, std::sin(1.01 * end), std::cos(1.01 * end)}};
  const std::vector<double> v = values(lobes, towards);
  ASSERT_EQ(v.size(), 6u);
  EXPECT_DOUBLE_EQ(v[0], 1);
  EXPECT_NEAR(v[2], 0, 1e-12);
  EXPECT_EQ(v[4], 0);
  for (const std::size_t i : {1u, 3u, 5u}) EXPECT_DOUBLE_EQ(v[i], 1);
}

}  // namespace
}  // namespace likeness::realis
