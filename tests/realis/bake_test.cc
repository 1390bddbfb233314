#include "realis/bake.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/realis/domes.h"

namespace likeness::realis {
namespace {

bool always(double, std::string_view) { return true; }

// Texels with random photographs, renders, cosines.
Subject some_subject(std::size_t texels, const std::vector<glm::dvec3>& lights, unsigned seed) {
  Subject s;
  s.width = static_cast<int>(texels), s.height = 1;
  s.to_lights = lights;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(0, 1), cosine(-0.3f, 1);
  for (std::size_t i = 0; i < lights.size(); ++i) s.lights.push_back(i);
  for (std::size_t t = 0; t < texels; ++t) {
    s.pixels.push_back(static_cast<std::uint32_t>(t));
    for (std::size_t i = 0; i < lights.size(); ++i) {
      s.photo.push_back({value(random), value(random), value(random)});
      s.render.push_back({value(random), value(random), value(random)});
      s.cosine.push_back(cosine(random)), s.weight.push_back(1);
    }
  }
  return s;
}
// A residual that is smooth in the direction, plus noise.
Subject smooth_subject(std::size_t texels, const std::vector<glm::dvec3>& lights, double noise, unsigned seed) {
  Subject s = some_subject(texels, lights, seed);
  std::mt19937 random(seed + 1);
  std::normal_distribution<double> normal(0, noise);
  for (std::size_t t = 0; t < texels; ++t) {
    const double a = 0.3 + 0.001 * static_cast<double>(t % 100);
    for (std::size_t i = 0; i < lights.size(); ++i) {
      const std::size_t at = s.samples_of(t) + i;
      s.cosine[at] = 1;
      const double e = a * std::exp(3 * (lights[i].x - 0.6)) + 0.2 * lights[i].y;
      for (std::size_t c = 0; c < 3; ++c) s.photo[at][c] = s.render[at][c] + static_cast<float>(e + normal(random));
    }
  }
  return s;
}

double photo_minus(const Subject& s, const Bake& b, std::size_t texel, std::size_t i, std::size_t c) {
  const std::size_t at = s.samples_of(texel) + i;
  const auto e = Residual(b, s.to_lights[i]).at(texel, static_cast<double>(s.cosine[at]));
  return static_cast<double>(s.photo[at][c]) - (static_cast<double>(s.render[at][c]) + e[c]);
}

// The demand is 1e-5 of the photographs (here: of 1). Coefficients are floats: 6e-8 each, of size up to 30.
TEST(Bake, WithAsManyLobesAsLightsGivesThePhotographsBack) {
  for (const std::size_t lights : {std::size_t{1}, std::size_t{2}, std::size_t{12}, std::size_t{96}}) {
    const Subject s = some_subject(20, test::dome(lights), 1);
    const Bake b = bake(s, {.channels = Channels::kRgb, .is_exact = true}, always);
    ASSERT_EQ(b.basis.lobes.size(), lights);
    for (std::size_t t = 0; t < s.texels(); ++t)
      for (std::size_t i = 0; i < lights; ++i)
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(photo_minus(s, b, t, i, c), 0, 1e-5);
  }
}

TEST(Bake, OfLuminanceGivesTheLuminanceBack) {
  const Subject s = some_subject(20, test::dome(24), 2);
  const Bake b = bake(s, {.is_exact = true}, always);
  for (std::size_t t = 0; t < s.texels(); ++t)
    for (std::size_t i = 0; i < 24; ++i)
      EXPECT_NEAR(0.2126 * photo_minus(s, b, t, i, 0) + 0.7152 * photo_minus(s, b, t, i, 1) +
                      0.0722 * photo_minus(s, b, t, i, 2),
                  0, 1e-5);
}

// A smooth residual under noise: 0.01 in each channel is 0.0075 in luminance. What is held out is near the noise and far
// below the residual, and half as many lobes as lights are enough for that.
TEST(Bake, FindsTheLobesThatTheResidualNeeds) {
  const Subject s = smooth_subject(600, test::dome(64), 0.01, 3);
  const Bake b = bake(s, {}, always);
  ASSERT_FALSE(b.ladder.empty());
  const Choice& chosen = b.ladder[b.chosen];
  EXPECT_LT(chosen.held_out, 0.013);
  EXPECT_GT(chosen.held_out, 0.0073) << "below the noise: it was not held out";
  EXPECT_GT(chosen.plain, 0.2);
  EXPECT_LE(b.ladder[chosen_of(b.ladder, 0.1)].basis.lobes.size(), 32u);
}

// Only noise: more lobes cannot help, and the coefficients stay smaller than the noise.
TEST(Bake, DoesNotRingWhereThereIsOnlyNoise) {
  Subject s = smooth_subject(300, test::dome(48), 0.05, 4);
  for (std::size_t i = 0; i < s.photo.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      static std::mt19937 random(5);
      static std::normal_distribution<float> normal(0, 0.05f);
      s.photo[i][c] = s.render[i][c] + normal(random);
    }
  const Bake b = bake(s, {.lobes = 64}, always);
  EXPECT_LT(b.ladder[0].held_out, 1.02 * b.ladder[0].plain);
  double most = 0;
  for (std::size_t t = 0; t < s.texels(); ++t)
    for (const glm::dvec3& direction : test::dome(200))
      most = std::max(most, std::abs(Residual(b, direction).at(t, 1)[0]));
  EXPECT_LT(most, 0.05);
}

TEST(Bake, KeepsAsManyLobesAsAskedForAndFitsThemAgain) {
  const Subject s = smooth_subject(300, test::dome(48), 0.005, 6);
  const Bake all = bake(s, {.lobes = 32}, always), few = bake(s, {.lobes = 32, .dominant = 8}, always);
  EXPECT_EQ(few.kept, 8u);
  double cut = 0, fitted = 0;
  for (std::size_t t = 0; t < s.texels(); ++t) {
    const float* c = few.coefficients.data() + t * 32;
    EXPECT_LE(std::count_if(c, c + 32, [](float x) { return x != 0; }), 8);
    Bake without = all;
    for (std::size_t k = 0; k < 32; ++k)
      if (c[k] == 0) without.coefficients[t * 32 + k] = 0;
    if (t < 20)
      for (std::size_t i = 0; i < 48; ++i)
        cut += std::abs(photo_minus(s, without, t, i, 1)), fitted += std::abs(photo_minus(s, few, t, i, 1));
  }
  EXPECT_LT(fitted, 0.7 * cut);
}

TEST(Bake, IsTheSameWhateverTheOrderOfThreads) {
  const Subject s = smooth_subject(5000, test::dome(20), 0.01, 7);
  EXPECT_EQ(bake(s, {.lobes = 12}, always).coefficients, bake(s, {.lobes = 12}, always).coefficients);
}

TEST(Bake, OfDegenerateSubjectsIsFiniteAndSmall) {
  std::vector<std::vector<glm::dvec3>> all{{glm::dvec3(0, 0, 1)}, std::vector(8, glm::dvec3(0, 0, 1))};
  all.emplace_back();
  for (int i = 0; i < 7; ++i) all.back().emplace_back(std::cos(0.4 * i), std::sin(0.4 * i), 0.0);
  for (const auto& lights : all) {
    Subject s = some_subject(40, lights, 8);
    for (std::size_t i = 0; i < lights.size(); ++i) {
      s.weight[s.samples_of(3) + i] = 0;                             // a texel that no light sees
      s.photo[s.samples_of(4) + i] = s.render[s.samples_of(4) + i];  // nothing to explain
      s.photo[s.samples_of(5) + i] = {-0.1f, -0.1f, -0.1f};          // below black
    }
    for (auto& c : s.photo[s.samples_of(6)]) c *= 100;
    for (const BakeOptions& options : {BakeOptions{}, BakeOptions{.lobes = 30}, BakeOptions{.lobes = 9, .dominant = 4},
                                       BakeOptions{.is_exact = true}}) {
      const Bake b = bake(s, options, always);
      for (const float c : b.coefficients) EXPECT_TRUE(std::isfinite(c));
      for (const glm::dvec3& direction : test::dome(30)) {
        EXPECT_EQ(Residual(b, direction).at(3, 1)[0], 0);
        EXPECT_NEAR(Residual(b, direction).at(4, 1)[0], 0, 1e-6);
      }
    }
  }
  const Bake none = bake(some_subject(0, test::dome(3), 9), {}, always);
  EXPECT_TRUE(none.coefficients.empty());
}

}  // namespace
}  // namespace likeness::realis
