#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "olat/registration/gain.h"
#include "olat/registration/noise.h"
#include "olat/registration/order.h"
#include "olat/registration/shift.h"
#include "tests/olat/planted.h"

namespace likeness::registration {
namespace {

using image::Picture;
using olat_test::Ball;
using olat_test::ball_mask;
using olat_test::ball_normals;
using olat_test::ball_under;
using olat_test::Planted;
using olat_test::ring_of_lights;

// The noise of a camera with 1000 electrons at light 0.1 and a read noise of 0.2 % of white.
constexpr Planted kCamera{.read_noise = 2e-3, .shot_noise = 1e-4};

Planted camera(unsigned seed) {
  Planted planted = kCamera;
  planted.seed = seed;
  return planted;
}

struct Case {
  double x, y;
};
constexpr std::array kShifts{Case{0, 0},      Case{1.5, 0},     Case{0, -1.5},
                             Case{-0.7, 1.2}, Case{0.25, 0.25}, Case{5.4, -7.3}};

TEST(Shift, OfATexturedObjectIsFoundToATenthOfAPixelInEveryPair) {
  const Ball still;
  unsigned seed = 1;
  for (const Case& planted : kShifts)
    for (const auto& light : ring_of_lights(4)) {
      Ball moved = still;
      moved.x = planted.x, moved.y = planted.y;
      Planted noise = camera(seed++);
      noise.gain_ev = 0.5;
      const Shift shift = shift_between(ball_under(moved, light, noise), ball_under(still, light), ball_mask(moved),
                                        kCamera.read_noise);
      ASSERT_TRUE(shift.is_measured());
      EXPECT_NEAR(shift.x, planted.x, 0.1) << planted.x << " " << planted.y << " sigma " << shift.sigma();
      EXPECT_NEAR(shift.y, planted.y, 0.1) << planted.x << " " << planted.y << " sigma " << shift.sigma();
      EXPECT_LT(shift.sigma(), 0.1);
    }
}

TEST(Shift, OfASmoothObjectIsFoundToATenthOfAPixelFromTheLightsOfACamera) {
  Ball still;
  still.texture = 0;
  unsigned seed = 100;
  for (const Case& planted : kShifts) {
    Ball moved = still;
    moved.x = planted.x, moved.y = planted.y;
    std::vector<Shift> shifts;
    for (const auto& light : ring_of_lights(9))
      shifts.push_back(shift_between(ball_under(moved, light, camera(seed++)), ball_under(still, light),
                                     ball_mask(moved), kCamera.read_noise));
    const Shift shift = combined(shifts);
    ASSERT_TRUE(shift.is_measured());
    EXPECT_NEAR(shift.x, planted.x, 0.1) << planted.x << " " << planted.y << " sigma " << shift.sigma();
    EXPECT_NEAR(shift.y, planted.y, 0.1) << planted.x << " " << planted.y << " sigma " << shift.sigma();
    EXPECT_LT(shift.sigma(), 0.1);
  }
}

TEST(Shift, IsNotPulledByShadowsAndHighlightsThatTheRenderDoesNotHave) {
  const Ball still;
  Ball moved = still;
  moved.x = 1.5, moved.highlight = 1.5, moved.shadow = 0.08;
  std::vector<Shift> shifts;
  unsigned seed = 200;
  for (const auto& light : ring_of_lights(5))
    shifts.push_back(shift_between(ball_under(moved, light, camera(seed++)), ball_under(still, light), ball_mask(moved),
                                   kCamera.read_noise));
  const Shift shift = combined(shifts);
  EXPECT_NEAR(shift.x, 1.5, 0.1);
  EXPECT_NEAR(shift.y, 0, 0.1);
}

TEST(Shift, SaysSigmasThatItsErrorsHave) {
  const Ball still;
  Ball moved = still;
  moved.x = 0.6;
  double squares = 0;
  constexpr int kTrials = 40;
  for (int i = 0; i < kTrials; ++i) {
    Planted noise = camera(300u + static_cast<unsigned>(i));
    noise.read_noise = 0.02;
    const Shift shift =
        shift_between(ball_under(moved, {0, 0, 1}, noise), ball_under(still, {0, 0, 1}), ball_mask(moved), 0.02);
    ASSERT_TRUE(shift.is_measured());
    squares += (shift.x - 0.6) * (shift.x - 0.6) / shift.xx;
  }
  // 1 if the sigmas were exact; 40 trials know it to a factor of 1.25.
  EXPECT_LT(std::sqrt(squares / kTrials), 2);
  EXPECT_GT(std::sqrt(squares / kTrials), 0.25);
}

TEST(Shift, IsNotMeasuredWhereThereIsNothingToSee) {
  const Ball ball;
  const Picture lit = ball_under(ball, {0, 0, 1});
  EXPECT_FALSE(shift_between(Picture(160, 160), lit, {}, 1e-3).is_measured()) << "a black photo";
  EXPECT_FALSE(shift_between(Picture(1, 1), Picture(1, 1), {}, 1e-3).is_measured());
  EXPECT_FALSE(shift_between(lit, lit, std::vector<float>(160 * 160, 0.0f), 1e-3).is_measured());
  Picture flat(64, 64);
  std::fill(flat.rgb.begin(), flat.rgb.end(), 0.5f);
  EXPECT_FALSE(shift_between(flat, flat, {}, 1e-3).is_measured());
  std::mt19937 random(5);
  std::normal_distribution<float> normal(0.5f, 0.01f);
  for (float& v : flat.rgb) v = normal(random);
  Picture other = flat;
  for (float& v : other.rgb) v = normal(random);
  const Shift shift = shift_between(flat, other, {}, 0.01);
  EXPECT_TRUE(!shift.is_measured() || shift.sigma() > 0.3)
      << "noise against noise: " << shift.x << " " << shift.sigma();
  EXPECT_FALSE(combined({}).is_measured());
  EXPECT_THROW(shift_between(lit, Picture(8, 8), {}, 0), std::invalid_argument);
}

// What is behind the subject in the photo is not in the render; the mask says so, and blur must not carry it in.
TEST(Shift, IsNotPulledByABackgroundThatTheRenderDoesNotHave) {
  Ball still;
  still.size = 64, still.radius = 26;
  Ball moved = still;
  moved.x = 1.5;
  const std::vector<float> mask = ball_mask(moved);
  std::vector<Shift> shifts;
  unsigned seed = 700;
  for (const auto& light : ring_of_lights(5)) {
    Picture photo = ball_under(moved, light, camera(seed++));
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        if (mask[static_cast<std::size_t>(64 * y + x)] == 0)
          for (std::size_t c = 0; c < 3; ++c) photo.at(x, y)[c] = x < 32 ? 3.0f : 0.3f;
    shifts.push_back(shift_between(photo, ball_under(still, light), mask, kCamera.read_noise));
  }
  EXPECT_NEAR(combined(shifts).x, 1.5, 0.1);
  EXPECT_NEAR(combined(shifts).y, 0, 0.1);
}

TEST(Shift, SurvivesPixelsThatAreNotFinite) {
  const Ball still;
  Ball moved = still;
  moved.x = 1.5;
  Picture photo = ball_under(moved, {0, 0, 1}, kCamera);
  for (int i = 0; i < 160; i += 10) photo.at(i, 80)[1] = std::numeric_limits<float>::quiet_NaN();
  const Shift shift = shift_between(photo, ball_under(still, {0, 0, 1}), ball_mask(moved), kCamera.read_noise);
  EXPECT_NEAR(shift.x, 1.5, 0.1);
}

TEST(Shift, OfACameraLeavesOutThePairThatStandsApart) {
  std::vector<Shift> shifts;
  for (int i = 0; i < 8; ++i) shifts.push_back({1.5 + 0.01 * (i % 3), -0.5, 1e-4, 0, 1e-4, 1000});
  shifts.push_back({9, 4, 1e-4, 0, 1e-4, 1000});
  const Shift shift = combined(shifts);
  EXPECT_NEAR(shift.x, 1.51, 0.02);
  EXPECT_NEAR(shift.y, -0.5, 0.02);
  // Two lights that each know one direction.
  const std::vector<Shift> crossed{{1.5, 7, 1e-4, 0, 9, 1000}, {-3, 0.5, 9, 0, 1e-4, 1000}};
  EXPECT_NEAR(combined(crossed).x, 1.5, 0.01);
  EXPECT_NEAR(combined(crossed).y, 0.5, 0.01);
}

TEST(Gain, OfHalfAStopIsFoundToAFiftiethUnderNoiseShadowsAndHighlights) {
  const Ball plain;
  Ball photographed = plain;
  photographed.highlight = 2, photographed.shadow = 0.15;
  unsigned seed = 400;
  for (const double ev : {0.0, 0.5, -0.5, 2.0})
    for (const auto& light : ring_of_lights(5)) {
      Planted planted = camera(seed++);
      planted.gain_ev = ev;
      const Gain gain = gain_between(ball_under(photographed, light, planted), ball_under(plain, light),
                                     ball_mask(plain), {2e-3, 2e-3, 2e-3});
      ASSERT_GT(gain.pixels, 0u);
      EXPECT_NEAR(gain.all, ev, 0.02);
      for (const double stops : gain.stops) EXPECT_NEAR(stops, ev, 0.02);
      EXPECT_LT(gain.sigma, 0.01);
    }
}

TEST(Gain, OfAChannelIsItsOwn) {
  const Ball ball;
  Planted planted = camera(7);
  planted.channel_ev = {0.3, 0, -0.2};
  const Gain gain = gain_between(ball_under(ball, {0, 0, 1}, planted), ball_under(ball, {0, 0, 1}), ball_mask(ball),
                                 {2e-3, 2e-3, 2e-3});
  EXPECT_NEAR(gain.stops[0], 0.3, 0.02);
  EXPECT_NEAR(gain.stops[1], 0, 0.02);
  EXPECT_NEAR(gain.stops[2], -0.2, 0.02);
}

TEST(Gain, IsNotDrawnUpByNoiseInTheDark) {
  Ball ball;
  ball.albedo = {0.01, 0.01, 0.01};
  Planted planted{.gain_ev = 0.5, .read_noise = 1e-3, .seed = 3};
  const Gain gain = gain_between(ball_under(ball, {0, 0, 1}, planted), ball_under(ball, {0, 0, 1}), ball_mask(ball),
                                 {1e-3, 1e-3, 1e-3});
  EXPECT_NEAR(gain.all, 0.5, 0.02) << "light of 5 sigma: the noise is a fifth of it";
  // Light that lies on the limit of what counts: the photo's noise must not choose.
  Picture flat(64, 64), seen(64, 64);
  std::mt19937 random(4);
  std::normal_distribution<float> noise(0, 1e-3f);
  for (std::size_t i = 0; i < flat.rgb.size(); ++i) flat.rgb[i] = 0.0101f, seen.rgb[i] = 0.0101f + noise(random);
  EXPECT_NEAR(gain_between(seen, flat, {}, {1e-3, 1e-3, 1e-3}).all, 0, 0.02);
  EXPECT_EQ(gain_between(Picture(32, 32), Picture(32, 32), {}, {0, 0, 0}).pixels, 0u);
  EXPECT_THROW(gain_between(Picture(2, 2), Picture(2, 2), {}, {-1, 0, 0}), std::invalid_argument);
}

TEST(Curve, ExponentOfPlantedPowersIsFound) {
  const Ball ball;
  unsigned seed = 500;
  for (const double exponent : {1.0, 1 / 2.2, 2.2}) {
    Planted planted = camera(seed++);
    planted.exponent = exponent;
    planted.gain_ev = 0.7;
    const Curve curve = curve_between(ball_under(ball, {0.5, 0.5, std::sqrt(0.5)}, planted),
                                      ball_under(ball, {0.5, 0.5, std::sqrt(0.5)}), ball_mask(ball), 2e-3);
    ASSERT_GT(curve.pixels, 0u);
    EXPECT_NEAR(curve.exponent, exponent, 0.02 * exponent) << "sigma " << curve.sigma;
  }
}

TEST(Curve, OfHighlightsAndShadowsThatTheRenderDoesNotHaveStaysNearOne) {
  const Ball plain;
  Ball photographed = plain;
  photographed.highlight = 1, photographed.shadow = 0.1;
  const Curve curve = curve_between(ball_under(photographed, {0.5, 0.5, std::sqrt(0.5)}, kCamera),
                                    ball_under(plain, {0.5, 0.5, std::sqrt(0.5)}), ball_mask(plain), 2e-3);
  EXPECT_NEAR(curve.exponent, 1, 0.05);
  EXPECT_EQ(curve_between(Picture(32, 32), plain.size == 32 ? Picture() : Picture(32, 32), {}, 0).pixels, 0u);
}

TEST(Darkness, FindsNoiseAndBlackLevelOfAPhoto) {
  const Ball ball;
  Planted planted{.read_noise = 3e-3, .black = 0.01, .seed = 9};
  const Darkness dark = darkness_of(ball_under(ball, {0, 0, 1}, planted));
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(dark.noise[c], 3e-3, 1.5e-4);  // 5000 second differences: 2 %
    EXPECT_NEAR(dark.level[c], 0.01, 3e-4);
  }
  planted.black = 0;
  EXPECT_NEAR(darkness_of(ball_under(ball, {0, 0, 1}, planted)).level[0], 0, 3e-4);
  EXPECT_EQ(darkness_of(Picture(3, 3)).noise[0], 0);
}

std::vector<Sketch> sketches_of(const Ball& ball, const std::vector<std::array<double, 3>>& lights, bool noisy) {
  std::vector<Sketch> sketches;
  unsigned seed = 600;
  for (const auto& light : lights)
    sketches.push_back(sketch_of(ball_under(ball, light, noisy ? camera(seed++) : Planted{}), ball_mask(Ball{})));
  return sketches;
}

TEST(Order, OfLightsThatAreRightRaisesNothing) {
  Ball photographed;
  photographed.highlight = 1, photographed.x = 1.5;
  const auto lights = ring_of_lights(13);
  EXPECT_TRUE(misplaced(sketches_of(photographed, lights, true), sketches_of(Ball{}, lights, false)).empty());
}

TEST(Order, SwappedLightsAreNamed) {
  Ball photographed;
  photographed.highlight = 1, photographed.x = 1.5;
  const auto lights = ring_of_lights(13);
  auto photos = sketches_of(photographed, lights, true);
  std::swap(photos[3], photos[4]);  // neighbours: 30 degrees apart
  std::swap(photos[7], photos[12]);
  const auto found = misplaced(photos, sketches_of(Ball{}, lights, false));
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].photo, 3u);
  EXPECT_EQ(found[0].render, 4u);
  EXPECT_EQ(found[1].photo, 4u);
  EXPECT_EQ(found[1].render, 3u);
  EXPECT_EQ(found[2].render, 12u);
  EXPECT_EQ(found[3].render, 7u);
  EXPECT_GT(found[0].found, found[0].own);
}

// Color that all photos share must not hide that two lights, 22 degrees apart, are swapped.
TEST(Order, NeighboursAreToldApartOnAStronglyTexturedObject) {
  Ball ball;
  ball.texture = 0.98;
  const auto lights = ring_of_lights(17);
  auto photos = sketches_of(ball, lights, true);
  const auto renders = sketches_of(ball, lights, false);
  std::swap(photos[3], photos[4]);
  const auto found = misplaced(photos, renders);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_GT(found[0].found - found[0].own, 0.1);  // 0.12, and 0.08 with what they share
}

TEST(Order, OneLightThatIsOffIsNotMisplacedAndShiftedNumbersAre) {
  const auto lights = ring_of_lights(9);
  auto photos = sketches_of(Ball{}, lights, true);
  const auto renders = sketches_of(Ball{}, lights, false);
  photos[2].clear();
  EXPECT_TRUE(misplaced(photos, renders).empty());
  photos = sketches_of(Ball{}, lights, true);
  std::rotate(photos.begin(), photos.begin() + 1, photos.end());
  EXPECT_EQ(misplaced(photos, renders).size(), 9u);
  EXPECT_TRUE(misplaced({}, {}).empty());
}

TEST(Assignment, IsTheBestOfAllPermutations) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    constexpr std::size_t kRows = 5, kColumns = 7;
    std::vector<double> score;
    for (std::size_t i = 0; i < kRows * kColumns; ++i) score.push_back(uniform(random));
    const auto sum = [&](const auto& columns) {
      double total = 0;
      for (std::size_t r = 0; r < kRows; ++r) total += score[r * kColumns + columns[r]];
      return total;
    };
    std::vector<std::size_t> order(kColumns);
    std::iota(order.begin(), order.end(), std::size_t{0});
    double best = -100;
    do best = std::max(best, sum(order));
    while (std::next_permutation(order.begin(), order.end()));
    EXPECT_NEAR(sum(assignment(score, kRows, kColumns)), best, 1e-12);
  }
  EXPECT_THROW(assignment({1, 2}, 2, 1), std::invalid_argument);
}

TEST(Mirror, LightsOfTheOtherHandAreTurnedOver) {
  const Ball ball;
  const Picture normals = ball_normals(ball);
  auto lights = ring_of_lights(9);
  for (auto& light : lights)
    light = {0.6 * light[0], 0.6 * light[1] + 0.2,
             std::sqrt(1 - 0.36 * light[0] * light[0] - std::pow(0.6 * light[1] + 0.2, 2))};
  std::vector<Sketch> photos = sketches_of(ball, lights, true);
  EXPECT_EQ(mirror_of(normals, ball_mask(ball), photos, lights).flips, 0);
  EXPECT_GT(mirror_of(normals, ball_mask(ball), photos, lights).own, 0.9);
  for (auto& light : lights) light[1] = -light[1];
  const Mirror mirror = mirror_of(normals, ball_mask(ball), photos, lights);
  EXPECT_EQ(flips_text(mirror.flips), "y");
  EXPECT_GT(mirror.found, mirror.own + 0.2);
  for (auto& light : lights) light = {-light[0], -light[1], light[2]};
  EXPECT_EQ(flips_text(mirror_of(normals, ball_mask(ball), photos, lights).flips), "x");
  for (auto& light : lights) light = {light[0], -light[1], -light[2]};
  EXPECT_EQ(flips_text(mirror_of(normals, ball_mask(ball), photos, lights).flips), "x, y and z");
}

}  // namespace
}  // namespace likeness::registration
