#include "render/exposure/pick.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "tests/render/exposure/pictures_of_light.h"

namespace likeness::exposure {
namespace {

using test::greys;
using test::kDenormal;
using test::kInfinity;
using test::kNan;
using test::scaled;
using test::scattered;

const Curve kGt{0.22, 0.532, 2.4e-4, 3.0};

Meter meter_of(const image::Picture& picture, std::span<const float> weights = {}) {
  Histogram histogram;
  histogram.add(picture, weights);
  return Meter(histogram, kGt);
}

struct Way {
  const char* name;
  std::function<std::optional<Pick>(const Meter&)> pick;
  double rounding;  // of scales that are no power of two [stop]
};
const std::vector<Way> kWays{
    {"linear", [](const Meter& m) { return pick_linear(m); }, 0.25},  // the best of a noisy count: its plateau is wide
    {"average", [](const Meter& m) { return pick_average(m); }, 4e-7},
    {"percentile", [](const Meter& m) { return pick_percentile(m, 0.9, 7); }, 1.0 / 709},
};

TEST(Picks, MoveByExactlyTheStopsOfAPowerOfTwo) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    const image::Picture picture = scattered(120, 90, 3, seed);
    for (const Way& way : kWays) {
      const double ev = way.pick(meter_of(picture))->ev;
      for (const int k : {-20, -3, 1, 17})
        EXPECT_NEAR(way.pick(meter_of(scaled(picture, std::exp2(static_cast<float>(k)))))->ev, ev - k,
                    1e-12)  // of the sum of the logarithms; the others are exact
            << way.name << " " << k;
    }
  }
}

TEST(Picks, MoveByTheLogarithmOfAnyScaleToTheirRounding) {
  const image::Picture picture = scattered(300, 200, 3, 5);
  for (const Way& way : kWays) {
    const double ev = way.pick(meter_of(picture))->ev;
    for (const float scale : {0.3f, 1.7f, 100.0f})
      EXPECT_NEAR(way.pick(meter_of(scaled(picture, scale)))->ev, ev - std::log2(static_cast<double>(scale)),
                  way.rounding)
          << way.name << " " << scale;
  }
}

TEST(Picks, DoNotSeeMaskedPixels) {
  const image::Picture picture = scattered(100, 80, 3, 7);
  std::vector<float> weights(8000);
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = i % 3 == 0 ? 0.0f : 1.0f;
  image::Picture other = picture;
  std::mt19937 random(8);
  for (std::size_t i = 0; i < weights.size(); i += 3)
    for (std::size_t c = 0; c < 3; ++c)
      other.rgb[3 * i + c] = std::array{1e6f, 0.0f, kNan, kInfinity, -1.0f}[random() % 5];
  for (const Way& way : kWays)
    EXPECT_EQ(way.pick(meter_of(picture, weights))->ev, way.pick(meter_of(other, weights))->ev) << way.name;
}

TEST(Picks, RiseWithTheZone) {
  const Meter meter = meter_of(scattered(100, 80, 3, 9));
  double before = -1e9;
  for (double zone = 0; zone <= 16; zone += 0.25) {
    const double ev = pick_percentile(meter, 0.5, zone)->ev;
    EXPECT_GT(ev, before);
    EXPECT_NEAR(ev_for(0.7, zone) - ev_for(0.7, 0), zone, 1e-12);
    before = ev;
  }
}

TEST(Picks, AreNoneWhereThereIsNoLight) {
  for (const image::Picture& picture : {greys({0, 0, -1}), greys({kNan}), image::Picture()})
    for (const Way& way : kWays) EXPECT_FALSE(way.pick(meter_of(picture))) << way.name;
}

TEST(Picks, OfOnePixelPutItWhereTheyAreAskedTo) {
  const Meter meter = meter_of(greys({0.045f}));
  EXPECT_NEAR(pick_average(meter)->ev, 2, 1e-6) << "0.045 is two stops below 0.18";
  EXPECT_NEAR(pick_percentile(meter, 0.99, 7)->ev, 4, 1e-6);
  const double ev = pick_linear(meter)->ev;
  EXPECT_NEAR(ev, std::log2(std::sqrt(0.22 * 0.532) / 0.045), 1.0 / 64) << "the middle of the line";
}

TEST(Picks, AreWithinTheViewsLimits) {
  EXPECT_NEAR(pick_average(meter_of(greys({1e-19f})))->ev, std::log2(0.18 / 1e-19), 1e-6);
  EXPECT_LE(pick_percentile(meter_of(greys({3e38f})), 1, 0)->ev, -5 + 2.5);
  for (const Way& way : kWays)
    for (const float light : {1e-38f, 3e38f, kInfinity, kDenormal})
      EXPECT_LE(std::abs(way.pick(meter_of(greys({light})))->ev), kMostStops) << way.name << " " << light;
}

// Every multiple of 1/64 stop, counted from the pixels.
TEST(PickLinear, IsTheBestOfAllWithinItsLimits) {
  const image::Picture picture = scattered(60, 50, 2, 11);
  const Meter meter = meter_of(picture);
  const Limits limits{0.03, 0.05};
  const Pick pick = *pick_linear(meter, limits);
  EXPECT_FALSE(pick.is_over_limits);
  const auto counted = [&](double ev) {
    std::array<int, 3> out{};  // linear, clipped, crushed
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
      const std::span<const float, 3> rgb(picture.rgb.data() + i, 3);
      const double light = std::exp2(ev) * static_cast<double>(luminance_of(rgb));
      out[0] += light >= kGt.toe_end && light <= kGt.shoulder_start;
      out[1] += std::exp2(ev) * static_cast<double>(std::max({rgb[0], rgb[1], rgb[2]})) >= kGt.clipped_from;
      out[2] += light < kGt.crushed_below;
    }
    return out;
  };
  int best = 0;
  for (int k = -20 * 64; k <= 20 * 64; ++k) {
    const auto [linear, clipped, crushed] = counted(k / 64.0);
    if (clipped <= 0.03 * 3000 && crushed <= 0.05 * 3000) best = std::max(best, linear);
  }
  const auto [linear, clipped, crushed] = counted(pick.ev);
  EXPECT_GE(linear, best - 4) << "3000 pixels, 1 in 700 of a stop's pixels at each border in another bin";
  EXPECT_LE(clipped, 0.03 * 3000 + 2);
  EXPECT_LE(crushed, 0.05 * 3000 + 2);
  EXPECT_EQ(pick.ev * 64, std::round(pick.ev * 64));
}

TEST(PickLinear, GivesUpTheLineForItsLimits) {
  // Nine in ten pixels could be on the line if the tenth were allowed to clip.
  std::vector<float> light(90, 0.01f);
  light.resize(100, 1.0f);
  const Meter meter = meter_of(greys(light));
  const Pick free = *pick_linear(meter, {1, 1}), kept = *pick_linear(meter, {0.01, 0.05});
  EXPECT_NEAR(meter.shares(free.ev).linear, 0.9, 1e-12);
  EXPECT_NEAR(meter.shares(free.ev).clipped, 0.1, 1e-12);
  EXPECT_EQ(meter.shares(kept.ev).clipped, 0);
  EXPECT_LT(kept.ev, free.ev);
  EXPECT_FALSE(kept.is_over_limits);
}

TEST(PickLinear, SaysWhereNoExposureKeepsToTheLimitsAndExceedsThemLeast) {
  // 40 stops between two halves: one of them is clipped or crushed, or both are.
  std::vector<float> light(60, 1e-6f);
  light.resize(100, 1e6f);
  const Meter meter = meter_of(greys(light));
  const Pick pick = *pick_linear(meter, {0.01, 0.05});
  EXPECT_TRUE(pick.is_over_limits);
  EXPECT_NEAR(meter.shares(pick.ev).linear, 0.6, 1e-12) << "clips 40 of 100 rather than crush 60";
  EXPECT_NEAR(meter.shares(pick.ev).clipped, 0.4, 1e-12);
}

TEST(PickLinear, IsNotMovedByAHotPixelOrABlackBackground) {
  std::vector<float> light;
  for (int i = 0; i < 1000; ++i) light.push_back(0.05f * std::exp2(static_cast<float>(i % 100) / 50));
  const double ev = pick_linear(meter_of(greys(light)))->ev;
  light.push_back(1e8f);
  light.push_back(kInfinity);
  EXPECT_EQ(pick_linear(meter_of(greys(light)))->ev, ev);
  light.resize(3000, 0);
  EXPECT_EQ(pick_linear(meter_of(greys(light)))->ev, ev);
}

TEST(LightOfPatch, IsTheMeanOfWhatIsFinite) {
  image::Picture picture(4, 4);
  for (float& v : picture.rgb) v = 0.36f;
  picture.at(1, 1)[0] = kNan;
  picture.at(0, 0)[1] = 100;  // outside
  const PatchLight light = light_of_patch(picture, {1, 1, 2, 3});
  EXPECT_EQ(light.pixels, 5u);
  EXPECT_EQ(light.left_out, 1u);
  EXPECT_NEAR(light.luminance, 0.36, 1e-7);
  EXPECT_NEAR(light.spread_stops, 0, 1e-6);
  EXPECT_NEAR(ev_for(light.luminance, 6), 0, 1e-6) << "a stop above middle grey is zone VI already";
  EXPECT_EQ(light_of_patch(picture, {1, 1, 1, 1}).pixels, 0u);
}

TEST(Ev100, IsTheExposureOfACameraAtIso100) {
  EXPECT_NEAR(ev100(1, 1, 100), 0, 1e-12);
  EXPECT_NEAR(ev100(16, 1.0 / 125, 100), 14.97, 0.01) << "sunny 16";
  EXPECT_NEAR(ev100(2.8, 1.0 / 60, 800), ev100(2.8, 1.0 / 60, 100) - 3, 1e-12);
}

}  // namespace
}  // namespace likeness::exposure
