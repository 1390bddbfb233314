#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "render/sampling/distribution.h"
#include "tests/brdf/chi_square.h"

namespace likeness::sampling {
namespace {

using brdf::chi_square;
using brdf::sidak;

constexpr float kLast = 0x1.fffffep-1f;  // the largest number below 1

// Every weight > 0 that a float of the sum can show is chosen; no other is, by any u; probabilities make 1.
void expect_sound(const std::vector<float>& weights, const char* what) {
  SCOPED_TRACE(what);
  const Distribution d(weights);
  ASSERT_EQ(d.size(), weights.size());
  double total = 0, sum = 0;
  for (const float w : weights) sum += static_cast<double>(w);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double expected = sum > 0 ? static_cast<double>(weights[i]) / sum : 1.0 / static_cast<double>(weights.size());
    EXPECT_NEAR(static_cast<double>(d.probability(i)), expected, 1.3e-7) << i;  // two roundings below 1
    EXPECT_GE(d.probability(i), 0.0f);
    total += static_cast<double>(d.probability(i));
  }
  EXPECT_NEAR(total, 1, 1e-6);  // differences of floats, each within 6e-8
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < 3000; ++i) {
    const float u = i == 0 ? 0.0f : i == 1 ? kLast : i == 2 ? 1e-30f : std::min(uniform(random), kLast);
    const auto c = d.choose(u);
    ASSERT_LT(c.index, weights.size()) << u;
    ASSERT_EQ(c.probability, d.probability(c.index)) << u;
    ASSERT_GT(c.probability, 0.0f) << u;
    if (sum > 0) {
      ASSERT_GT(weights[c.index], 0.0f) << u;
    }
    ASSERT_GE(c.rest, 0.0f);
    ASSERT_LT(c.rest, 1.0f);
  }
}

TEST(Distribution, IsSoundAtEveryEnd) {
  expect_sound({1}, "one");
  expect_sound({0}, "one of no weight");
  expect_sound({0, 0, 0}, "none has weight");
  expect_sound({0, 1}, "first is 0");
  expect_sound({0, 0, 0, 2, 3}, "the first three are 0");
  expect_sound({1, 0}, "last is 0");
  expect_sound({3, 1, 0, 0, 0}, "the last three are 0");
  expect_sound({0, 1, 0}, "both ends are 0");
  expect_sound({0, 1, 0, 0, 1, 0}, "0 in between");
  expect_sound({1, 1, 1}, "thirds");
  expect_sound({1e-30f, 1, 1e30f}, "huge range");
  expect_sound({1e30f, 1, 1e-30f}, "huge range, falling");
  expect_sound({std::numeric_limits<float>::max(), std::numeric_limits<float>::max()}, "sum beyond float");
  expect_sound({std::numeric_limits<float>::denorm_min(), 0, std::numeric_limits<float>::denorm_min()}, "denormal");
  std::vector<float> many(100000);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = i % 3 == 0 ? 0.0f : static_cast<float>(i % 17) + 0.1f;
  expect_sound(many, "many");
}

TEST(Distribution, EveryIndexIsChosenAsOftenAsItSays) {
  const std::vector<float> weights{0, 1, 5, 0, 0.01f, 3, 0, 2, 0};
  const Distribution d(weights);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<double> counts(weights.size(), 0), expected(weights.size(), 0);
  constexpr int kDraws = 400000;
  for (int i = 0; i < kDraws; ++i) ++counts[d.choose(std::min(uniform(random), kLast)).index];
  for (std::size_t i = 0; i < weights.size(); ++i) expected[i] = static_cast<double>(weights[i]) / 11.01 * kDraws;
  EXPECT_GE(chi_square(counts, expected).p, 0.01);  // significance 1 %; the seed is fixed
}

TEST(Distribution, WhatIsLeftOfTheNumberIsUniformInEveryIndex) {
  const std::vector<float> weights{1, 0, 5, 0.3f};
  const Distribution d(weights);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<std::vector<double>> counts(weights.size(), std::vector<double>(32, 0));
  std::vector<double> draws(weights.size(), 0);
  for (int i = 0; i < 400000; ++i) {
    const auto c = d.choose(std::min(uniform(random), kLast));
    ++counts[c.index][static_cast<std::size_t>(c.rest * 32)];
    ++draws[c.index];
  }
  const double least = sidak(0.01, 3);  // significance 1 % of the three
  for (const std::size_t i : {0u, 2u, 3u})
    EXPECT_GE(chi_square(counts[i], std::vector<double>(32, draws[i] / 32)).p, least) << i;
}

TEST(Distribution, IsMonotone) {
  const Distribution d(std::vector<float>{1, 0, 5, 0.3f, 2});
  double before = -1;
  for (int i = 0; i < 100000; ++i) {
    const auto c = d.choose(static_cast<float>(i) / 100000);
    const double now = static_cast<double>(c.index) + static_cast<double>(c.rest);
    ASSERT_GE(now, before) << i;
    before = now;
  }
}

// Counts of samples in each cell against the density, the density of samples against density(), and its mean.
void expect_sound(const std::vector<float>& weights, int width, int height, const char* what, double least) {
  SCOPED_TRACE(what);
  const Distribution2 d(weights, width, height);
  const auto cells = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<double> counts(cells, 0), expected(cells, 0);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(0, 1);
  constexpr int kDraws = 200000;
  int elsewhere = 0;
  for (int i = 0; i < kDraws; ++i) {
    const auto p = d.sample({std::min(uniform(random), kLast), std::min(uniform(random), kLast)});
    ASSERT_TRUE(p.at.x >= 0 && p.at.x < 1 && p.at.y >= 0 && p.at.y < 1);
    ASSERT_GT(p.density, 0.0f);
    if (std::abs(d.density(p.at) - p.density) > 1e-6f * p.density) ++elsewhere;
    ++counts[static_cast<std::size_t>(p.at.y * static_cast<float>(height)) * static_cast<std::size_t>(width) +
             static_cast<std::size_t>(p.at.x * static_cast<float>(width))];
  }
  EXPECT_LE(elsewhere, 8);  // that rounding puts on the border of the next cell: 3e-5 of them or less
  double total = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double density =
          static_cast<double>(d.density({(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                         (static_cast<float>(y) + 0.5f) / static_cast<float>(height)}));
      total += density / static_cast<double>(cells);
      expected[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
          density / static_cast<double>(cells) * kDraws;
    }
  EXPECT_NEAR(total, 1, 1e-6);
  EXPECT_GE(chi_square(counts, expected).p, least);
  double sum = 0;
  for (const float w : weights) sum += static_cast<double>(w);
  if (!(sum > 0)) return;
  for (std::size_t i = 0; i < cells; ++i)
    ASSERT_NEAR(expected[i] / kDraws, static_cast<double>(weights[i]) / sum, 4e-7) << i;  // of two rounded steps
}

TEST(Distribution2, SamplesByTheDensityThatItStates) {
  const double least = sidak(0.01, 8);  // significance 1 % of the eight; the seed is fixed
  expect_sound({1}, 1, 1, "one cell", least);
  expect_sound({1, 2, 3, 4, 5, 6}, 3, 2, "three by two", least);
  expect_sound({0, 0, 0, 4, 0, 6}, 3, 2, "an empty row", least);
  expect_sound({0, 0, 0, 0, 0, 0}, 3, 2, "nothing", least);
  expect_sound({0, 0, 0, 0, 0, 0, 7, 0, 0}, 3, 3, "one cell of many", least);
  expect_sound({1e30f, 1, 1e30f, 1}, 2, 2, "huge range", least);
  const float most = std::numeric_limits<float>::max();
  expect_sound({most, most, most, 0.5f * most}, 2, 2, "sums beyond float", least);
  std::vector<float> smooth;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 50; ++x)
      smooth.push_back(1 + std::sin(0.3f * static_cast<float>(x)) * std::cos(0.2f * static_cast<float>(y)));
  expect_sound(smooth, 50, 20, "smooth", least);
}

}  // namespace
}  // namespace likeness::sampling
