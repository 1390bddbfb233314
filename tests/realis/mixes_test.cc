#include "realis/mixes.h"

#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "brdf/realis/soft_cosine.h"
#include "realis/bake.h"
#include "realis/report/leave_one_out.h"
#include "realis/terminator.h"
#include "tests/realis/domes.h"

namespace likeness::realis {
namespace {

// Texels whose residual is a sum of two functions of the direction, with weights of their own; renders are black.
Subject two_functions(std::size_t lights, std::size_t texels) {
  Subject s;
  s.width = static_cast<int>(texels), s.height = 1;
  s.to_lights = test::dome(lights);
  for (std::size_t i = 0; i < lights; ++i) s.lights.push_back(i);
  for (std::size_t t = 0; t < texels; ++t) {
    s.pixels.push_back(static_cast<std::uint32_t>(t));
    const double a = std::sin(1.7 * static_cast<double>(t)), b = std::cos(0.9 * static_cast<double>(t));
    for (const glm::dvec3& d : s.to_lights) {
      const auto e = static_cast<float>(0.3 * a * std::exp(3 * (d.x - 1)) + 0.1 * b * d.y * d.z);
      s.photo.push_back({1 + e, 1 + e, 1 + e}), s.render.push_back({1, 1, 1});
      s.cosine.push_back(1), s.weight.push_back(1);
    }
  }
  return s;
}

double rms_of(const Subject& s, const Bake& bake) {
  double sum = 0;
  for (std::size_t i = 0; i < s.lights.size(); ++i) {
    const Residual residual(bake, s.to_lights[i]);
    for (std::size_t t = 0; t < s.texels(); ++t) {
      const std::size_t at = s.samples_of(t) + i;
      const double left = static_cast<double>(s.photo[at][0] - s.render[at][0]) - residual.at(t, 1)[0];
      sum += left * left;
    }
  }
  return std::sqrt(sum / static_cast<double>(s.photo.size()));
}

constexpr auto kGoOn = [](double, std::string_view) { return true; };

TEST(Mixes, TwoMixesHoldWhatTwoFunctionsMade) {
  const Subject s = two_functions(30, 200);
  BakeOptions options;
  options.mixes = 2;
  const double two = rms_of(s, bake(s, options, kGoOn));
  options.mixes = 1;
  const double one = rms_of(s, bake(s, options, kGoOn));
  EXPECT_LT(two, 0.01);  // of 0.08: the prior smooths a little
  EXPECT_GT(one, 2 * two);
}

TEST(Mixes, TheyForetellALightThatWasLeftOut) {
  const Subject all = two_functions(31, 200);
  Subject others = two_functions(31, 200);
  const std::size_t left = 12;
  for (std::size_t t = 0; t < all.texels(); ++t) others.weight[others.samples_of(t) + left] = 0;
  BakeOptions options;
  options.mixes = 6;
  const Bake baked = bake(others, options, kGoOn);
  const Residual residual(baked, all.to_lights[left]);
  double error = 0, plain = 0;
  for (std::size_t t = 0; t < all.texels(); ++t) {
    const double e = static_cast<double>(all.photo[all.samples_of(t) + left][0]) - 1;
    error += std::pow(e - residual.at(t, 1)[0], 2), plain += e * e;
  }
  EXPECT_LT(error, 0.05 * plain);
}

// Highlights narrower than the distance of lights: between lights the lobes are the Gaussian process that they stand for.
TEST(Mixes, TheyForetellHighlightsAsTheGaussianProcessDoes) {
  constexpr std::size_t kLights = 60;
  constexpr double kLength = 0.42;
  Subject all = two_functions(kLights, 300);
  for (std::size_t t = 0; t < all.texels(); ++t) {
    const double turn = 2.4 * static_cast<double>(t), tilt = 0.9 * std::sqrt((static_cast<double>(t) + 0.5) / 300);
    const glm::dvec3 axis(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
    for (std::size_t i = 0; i < kLights; ++i) {
      const auto e = static_cast<float>(std::exp(20 * (glm::dot(axis, all.to_lights[i]) - 1)));
      all.photo[all.samples_of(t) + i] = {1 + e, 1 + e, 1 + e};
    }
  }
  const auto prior = [&](const glm::dvec3& a, const glm::dvec3& b) {
    const double q = std::sqrt(3.0) * glm::length(a - b) / kLength;
    return 100 * ((1 + q) * std::exp(-q) + 10);
  };
  double of_mixes = 0, of_process = 0;
  for (const std::size_t left : {7u, 21u, 33u, 48u}) {
    const Subject others = without(all, std::span(&left, 1));
    BakeOptions options;
    const Bake baked = bake_with(others, Mixes(others, kLength, options.floor, 1).first(kLights), options, kGoOn);
    const Residual residual(baked, all.to_lights[left]);
    const auto count = static_cast<Eigen::Index>(others.lights.size());
    Eigen::MatrixXd system = Eigen::MatrixXd::Identity(count, count);
    Eigen::VectorXd towards(count), e(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      towards[i] = prior(others.to_lights[std::size_t(i)], all.to_lights[left]);
      for (Eigen::Index k = 0; k < count; ++k)
        system(i, k) += prior(others.to_lights[std::size_t(i)], others.to_lights[std::size_t(k)]);
    }
    const Eigen::VectorXd weights = system.llt().solve(towards);
    for (std::size_t t = 0; t < all.texels(); ++t) {
      for (Eigen::Index i = 0; i < count; ++i)
        e[i] = static_cast<double>(others.photo[others.samples_of(t) + std::size_t(i)][0]) - 1;
      const double want = static_cast<double>(all.photo[all.samples_of(t) + left][0]) - 1;
      of_mixes += std::pow(residual.at(t, 1)[0] - want, 2), of_process += std::pow(weights.dot(e) - want, 2);
    }
  }
  EXPECT_LT(std::sqrt(of_mixes / of_process), 1.1) << "of 1 where lobes could be any function";
}

TEST(Mixes, HardCasesAreFinite) {
  for (const std::size_t lights : {std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
    Subject s = two_functions(lights, 7);
    s.photo[0] = {std::numeric_limits<float>::quiet_NaN(), 0, 0}, s.weight[0] = 0;
    BakeOptions options;
    options.mixes = 40;
    const Bake made = bake(s, options, kGoOn);
    EXPECT_LE(made.basis.size(), lights);
    for (const float c : made.coefficients) ASSERT_TRUE(std::isfinite(c));
    for (const double m : made.basis.mix) ASSERT_TRUE(std::isfinite(m));
  }
  // The same light five times, a subject that is as its render, no texel, no light.
  Subject same = two_functions(5, 7);
  for (glm::dvec3& d : same.to_lights) d = {0, 0, 1};
  Subject none = two_functions(5, 7);
  none.photo = none.render;
  for (const Subject& s : {same, none, two_functions(5, 0), two_functions(0, 5)}) {
    BakeOptions options;
    options.mixes = 3;
    for (const float c : bake(s, options, kGoOn).coefficients) ASSERT_TRUE(std::isfinite(c));
  }
}

TEST(Mixes, SquaresKeepTheSignAndEveryStep) {
  using baked::stored_of, baked::worth_of;
  using enum baked::Bits;
  for (const auto& [bits, zero, last] : {std::tuple(kFour, 8, 15), std::tuple(kEightSquared, 128, 255)}) {
    const auto of = [](int n) { return static_cast<std::uint8_t>(n); };
    double before = -HUGE_VAL;
    for (int n = 1; n <= last; ++n) {
      const double worth = worth_of(of(n), 0.3, bits);
      EXPECT_EQ(stored_of(worth, 0.3, bits), n);
      EXPECT_GT(worth, before);
      before = worth;
    }
    EXPECT_EQ(worth_of(of(zero), 2, bits), 0);
    EXPECT_EQ(worth_of(of(last), 2, bits), 2);
    EXPECT_EQ(worth_of(1, 2, bits), -2);
    EXPECT_EQ(stored_of(std::nan(""), 1, bits), zero);
    EXPECT_EQ(stored_of(1, 0, bits), zero);
    EXPECT_EQ(stored_of(-HUGE_VAL, 1, bits), 1) << "clipped";
  }
}

// A highlight is a hundred times what most texels have: squares keep those to the same part of them.
TEST(Mixes, SquaresKeepSmallCoefficientsBesideLargeOnes) {
  using enum baked::Bits;
  const auto error = [](double c, baked::Bits bits) {
    return std::abs(baked::worth_of(baked::stored_of(c, 1, bits), 1, bits) - c) / c;
  };
  for (const double c : {0.0031, 0.0107, 0.0213}) {
    EXPECT_LT(error(c, kEightSquared), 1 / (127 * std::sqrt(c))) << "half a step of the root: 2 sqrt(c) / 254";
    EXPECT_LT(error(c, kEightSquared), error(c, kEight));
  }
}

TEST(Mixes, OfFourBitsAreNearAndOfEightBitsNearer) {
  const Subject s = two_functions(30, 200);
  BakeOptions options;
  options.mixes = 2, options.bits = baked::Bits::kFour;
  const Bake made = bake(s, options, kGoOn);
  EXPECT_EQ(baked::bytes_of_texel(made), 1u);
  const double four = rms_of(s, {baked::quantised(made), {}, 0});
  EXPECT_LT(four, 0.03);
  options.bits = baked::Bits::kEight;
  const Bake finer = bake(s, options, kGoOn);
  EXPECT_EQ(finer.bits, baked::Bits::kEightSquared) << "as mixes are stored";
  EXPECT_LT(rms_of(s, {baked::quantised(finer), {}, 0}), 0.2 * four);
}

TEST(Terminator, TheMeanOfASpreadCosineIsThatOfManyDraws) {
  constexpr double kSpread = 0.1;
  for (const double cosine : {-0.25, -0.05, 0.0, 0.1, 0.4}) {
    double sum = 0, weight = 0;
    for (int i = -4000; i <= 4000; ++i) {
      const double z = i * 1e-3 * 1.5, w = std::exp(-0.5 * z * z);
      sum += w * std::max(cosine + kSpread * z, 0.0), weight += w;
    }
    EXPECT_NEAR(std::max(cosine, 0.0) + brdf::beyond_hard(cosine, kSpread), sum / weight, 1e-5);
  }
  EXPECT_EQ(brdf::beyond_hard(0.1, 0.0), 0);
}

TEST(Terminator, ItFindsTheSpreadAndTheLeastThatPhotographsWereMadeWith) {
  Subject s;
  s.width = 4000, s.height = 1;
  s.to_lights = {{0, 0, 1}}, s.lights = {0};
  for (std::uint32_t t = 0; t < 4000; ++t) {
    const double cosine = -0.6 + 1.6 * t / 4000.0;
    const auto hard = static_cast<float>(0.2 * std::max(cosine, 0.0));
    const double soft = 0.2 * (std::max(cosine, 0.0) + brdf::beyond_hard(cosine, 0.1));
    const auto photo = static_cast<float>(std::max(soft, 0.2 * 0.03));
    s.pixels.push_back(t), s.facing.push_back({0.2f, 0.2f, 0.2f}), s.cosine.push_back(static_cast<float>(cosine));
    s.weight.push_back(1), s.render.push_back({hard, hard, hard}), s.photo.push_back({photo, photo, photo});
  }
  const Terminator found = terminator_of(s);
  EXPECT_EQ(found.spread, 0.1);
  EXPECT_NEAR(found.least, 0.03, 1e-3);
  soften(s, found);
  for (std::size_t t = 0; t < s.texels(); ++t)
    ASSERT_NEAR(std::max(s.render[t][0], s.least_of(t, 0, 0)), s.photo[t][0], 1e-5) << t;
  // Of renders of which no base color is known nothing is found.
  s.facing.clear();
  EXPECT_EQ(terminator_of(s).spread, 0);
}

}  // namespace
}  // namespace likeness::realis
