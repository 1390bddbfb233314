#include "brdf/realis/jitter.h"

#include <gtest/gtest.h>

#include "tests/brdf/chi_square.h"
#include "tests/brdf/realis/by_definition.h"

// A few lobes at a time: the mean stays.
namespace likeness::brdf {
namespace {

constexpr std::size_t kCases = 6, kCounts = 4;
constexpr std::size_t kDraws[kCounts] = {1, 2, 3, 8};

TEST(Jitter, HasTheResidualAsItsMean) {
  Random random(1);
  for (std::size_t i = 0; i < kCases; ++i) {
    const Drawn drawn = drawn_texel(random, 6);
    const Vec3<double> v = random.direction(-1);
    const double want = residual(drawn.lobes, drawn.texel, v);
    for (const std::size_t count : kDraws) {
      constexpr int kSamples = 200000;
      double sum = 0, squares = 0;
      for (int s = 0; s < kSamples; ++s) {
        const double x = jittered_residual(drawn.lobes, drawn.texel, v, float(random.uniform()), count);
        sum += x, squares += x * x;
      }
      const double mean = sum / kSamples, sigma = std::sqrt(std::max(0.0, squares / kSamples - mean * mean) / kSamples);
      // 24 tests together at 4.5 sigma: 2e-4 by chance, and the seed is fixed. Shares are floats.
      EXPECT_NEAR(mean, want, 4.5 * sigma + 1e-6 * magnitude(drawn.written)) << "texel " << i << ", " << count;
    }
  }
}

TEST(Jitter, DrawsEachLobeByTheSizeOfItsCoefficient) {
  Random random(2);
  for (std::size_t i = 0; i < kCases; ++i) {
    Drawn drawn = drawn_texel(random);
    drawn.texel.coefficients[0][i] = 128;  // one that is never drawn
    std::vector<double> expected;
    double total = 0;
    for (std::size_t j = 0; j < kRealisDominant; ++j)
      expected.push_back(j == i ? 0 : std::abs(drawn.written[j].coefficient)), total += expected.back();
    for (const std::size_t count : {std::size_t{1}, std::size_t{3}}) {
      constexpr double kSamples = 100000;
      std::vector<double> drawn_at(kRealisDominant), want = expected;
      for (double& x : want) x *= kSamples * double(count) / total;
      for (int s = 0; s < int(kSamples); ++s)
        for_each_drawn(drawn.lobes, drawn.texel, float(random.uniform()), count,
                       [&](std::size_t j, float) { ++drawn_at[j]; });
      // Draws of one u are not independent for count 3, but spread more evenly: the statistic is smaller, not larger.
      const ChiSquare test = chi_square(drawn_at, want);
      EXPECT_GE(test.p, sidak(0.01, 2 * kCases)) << "texel " << i << ", " << count << ": " << test.statistic;
      EXPECT_EQ(drawn_at[i], 0);
    }
  }
}

TEST(Jitter, HasNoVarianceWhereLobesAreAlike) {
  Random random(3);
  RealisLobes lobes;
  RealisTexel<1> texel;
  for (std::size_t j = 0; j < kRealisDominant; ++j) {
    lobes.place(j, Vec3<float>(random.direction()), 0, float(random.uniform(0.1, 1)));  // sharpness 0: all are 1
    texel.lobes[j] = std::uint8_t(j);
    texel.coefficients[0][j] = std::uint8_t(130 + random.index(125));
  }
  const Vec3<float> v(0, 0, 1);
  const float want = residual(lobes, texel, v);
  for (int i = 0; i < 1000; ++i)
    for (const std::size_t count : kDraws)
      ASSERT_NEAR(jittered_residual(lobes, texel, v, float(random.uniform(0, 1 - 1e-7)), count), want, 2e-6 * want);
}

TEST(Jitter, OfThreeChannelsHasTheirMeans) {
  Random random(4);
  const Drawn drawn = drawn_texel(random, 6);
  RealisTexel<3> rgb;
  rgb.lobes = drawn.texel.lobes;
  for (auto& channel : rgb.coefficients)
    for (auto& byte : channel) byte = std::uint8_t(1 + random.index(255));
  rgb.coefficients[0][2] = rgb.coefficients[1][2] = 128;  // only blue has it
  const Vec3<double> v = random.direction();
  const Rgb<double> want = residual(drawn.lobes, rgb, v);
  Rgb<double> mean;
  // One u after the other in even steps: the mean over u itself, but for the steps at which a lobe gives way to the next.
  constexpr int kSteps = 200000;
  for (int s = 0; s < kSteps; ++s)
    mean = mean + jittered_residual(drawn.lobes, rgb, v, float((s + 0.5) / kSteps), 2) * (1.0 / kSteps);
  EXPECT_NEAR(mean.r, want.r, 2e-4);
  EXPECT_NEAR(mean.g, want.g, 2e-4);
  EXPECT_NEAR(mean.b, want.b, 2e-4);
}

TEST(Jitter, HoldsAtTheEnds) {
  Random random(5);
  const auto finite = [](const Drawn& d, float u, std::size_t count) {
    std::size_t calls = 0;
    for_each_drawn(d.lobes, d.texel, u, count, [&](std::size_t j, float share) {
      ++calls;
      EXPECT_LT(j, kRealisDominant);
      EXPECT_TRUE(std::isfinite(share) && share > 0);
    });
    return calls;
  };
  for (int i = 0; i < 2000; ++i) {
    Drawn drawn = drawn_texel(random);
    for (int j = 0; j < 3; ++j) drawn.texel.coefficients[0][random.index(8)] = 128;
    if (i % 3 == 0) drawn.lobes.place(drawn.texel.lobes[7], {0, 0, 1}, 1, 1e-9f);  // its interval rounds to nothing
    for (const float u : {0.f, 1e-45f, 0.5f, 1 - 0x1p-24f, 1.f})
      for (const std::size_t count : kDraws) EXPECT_EQ(finite(drawn, u, count), count) << u;
    EXPECT_EQ(finite(drawn, 0.5f, 0), 0u);
  }
  const Drawn empty;
  EXPECT_EQ(finite(empty, 0.5f, 4), 0u) << "all coefficients are 0";
  EXPECT_EQ(jittered_residual(empty.lobes, empty.texel, Vec3<float>(0, 0, 1), 0.5f, 4), 0);
}

}  // namespace
}  // namespace likeness::brdf
