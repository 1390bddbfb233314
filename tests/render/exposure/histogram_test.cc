#include "render/exposure/histogram.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "render/exposure/measure.h"
#include "tests/render/exposure/pictures_of_light.h"

namespace likeness::exposure {
namespace {

using test::greys;
using test::kDenormal;
using test::kInfinity;
using test::kNan;
using test::scattered;

Histogram histogram_of(const image::Picture& picture, std::span<const float> weights = {}, float floor = 0) {
  Histogram out;
  out.add(picture, weights, floor);
  return out;
}

bool are_equal(std::span<const Bin> one, std::span<const Bin> other) {
  return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                    [](const Bin& a, const Bin& b) { return a.weight == b.weight && a.place == b.place; });
}

TEST(Histogram, HasBinsOfAtMostAStopBy710ThatRiseAndHoldTheirLight) {
  for (std::size_t i = 1; i < Histogram::kBins; ++i) {
    const double low = Histogram::light_of(i - 1), high = Histogram::light_of(i);
    ASSERT_GT(high, low);
    ASSERT_LE(std::log2(high / low), 1.0 / 709);
    ASSERT_EQ(Histogram::bin_of(static_cast<float>(high)), i);
    ASSERT_EQ(Histogram::bin_of(std::nextafter(static_cast<float>(high), 0.0f)), i - 1);
  }
  EXPECT_EQ(Histogram::light_of(0), std::exp2(-64));
  EXPECT_EQ(Histogram::bin_of(1.0f), 64u * 1024);
}

TEST(Histogram, IsExactForAPictureOfOneGrey) {
  for (const float grey : {0.18f, 0.2200001f, 1.0f, 3e-15f, 7e15f}) {
    const Distribution light(histogram_of(greys({grey, grey, grey})).luminance());
    const double luminance = luminance_of(std::array{grey, grey, grey});
    EXPECT_EQ(light.percentile(0.5), luminance);
    EXPECT_EQ(light.mean_log2(), std::log2(luminance));
    EXPECT_EQ(light.below(luminance), 0u);
    EXPECT_EQ(light.below(std::nextafter(luminance, 1e30)), 3 * Histogram::kWhole);
  }
}

TEST(Histogram, CountsEachKindOfFloatByItsDefinition) {
  image::Picture all = greys({kNan, kInfinity, -kInfinity, -1, 0, kDenormal, 1, 1e-30f, 3e38f});
  all.rgb[3 * 6 + 2] = -0.5f;  // the grey 1 has a negative blue
  const Histogram h = histogram_of(all);
  EXPECT_EQ(h.counts().all, 9u);
  EXPECT_EQ(h.counts().not_number, 1u);
  EXPECT_EQ(h.counts().infinite, 2u);
  EXPECT_EQ(h.counts().negative, 3u) << "minus infinity, -1, and the blue";
  EXPECT_EQ(h.counts().denormal, 1u);
  EXPECT_EQ(h.counts().masked, 0u);
  EXPECT_EQ(h.weight(), 8 * Histogram::kWhole) << "all but NaN";
  EXPECT_EQ(h.black_weight(), 3 * Histogram::kWhole) << "minus infinity, -1 and 0";
  const Distribution light(h.luminance());
  EXPECT_EQ(light.weight(), 5 * Histogram::kWhole);
  EXPECT_EQ(light.below(1e-19), 2 * Histogram::kWhole) << "what is below the first bin is in it";
  EXPECT_EQ(light.percentile(0), std::exp2(-64)) << "at its beginning";
  EXPECT_NEAR(std::log2(light.percentile(1)), 64, 0.01) << "and what is above the last in that";
}

TEST(Histogram, TakesInfinityBesideMinusInfinityAndOverflowsOfFiniteLight) {
  image::Picture odd = greys({3e38f, 1});
  odd.rgb[3] = kInfinity;
  odd.rgb[4] = -kInfinity;
  const Histogram h = histogram_of(odd);
  EXPECT_EQ(h.counts().infinite, 1u) << "3e38 thrice is finite light";
  EXPECT_EQ(h.counts().not_number, 0u);
  EXPECT_EQ(h.black_weight(), Histogram::kWhole) << "more is taken from the green than the red gives";
  EXPECT_EQ(Distribution(h.brightest()).weight(), 2 * Histogram::kWhole);
}

TEST(Histogram, IsTheSameForEveryNumberOfThreadsAndOrder) {
  const image::Picture picture = scattered(1200, 400, 3, 1);
  const Histogram many = histogram_of(picture);
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Histogram single = histogram_of(picture);
  EXPECT_TRUE(are_equal(many.luminance(), single.luminance()));
  EXPECT_TRUE(are_equal(many.brightest(), single.brightest()));

  const image::Picture other = scattered(50, 40, 2, 2);
  Histogram forth = single, back = histogram_of(other);
  forth.add(other);
  back.add(single);
  EXPECT_TRUE(are_equal(forth.luminance(), back.luminance()));
  EXPECT_EQ(forth.weight(), back.weight());
  EXPECT_EQ(forth.counts().all, 482000u);
}

TEST(Histogram, LeavesOutWhatHasNoWeightAndHalvesWhatHasHalf) {
  const image::Picture picture = greys({0.1f, 0.2f, 0.4f, kNan, 0.8f});
  const std::vector<float> weights{1, 0.5f, 0, 0, kNan};
  const Histogram h = histogram_of(picture, weights);
  EXPECT_EQ(h.counts().masked, 3u);
  EXPECT_EQ(h.counts().not_number, 0u) << "what is masked is not looked at";
  EXPECT_EQ(h.weight(), Histogram::kWhole * 3 / 2);
  EXPECT_EQ(Distribution(h.luminance()).below(0.15), Histogram::kWhole);
  EXPECT_THROW(histogram_of(picture, std::vector<float>{1, 1}), std::invalid_argument);
}

TEST(Histogram, CountsLightAtOrBelowTheFloorAsBlack) {
  const Histogram h = histogram_of(greys({0.01f, 0.02f, 0.5f}), {}, luminance_of(std::array{0.02f, 0.02f, 0.02f}));
  EXPECT_EQ(h.black_weight(), 2 * Histogram::kWhole);
  EXPECT_EQ(h.weight(), 3 * Histogram::kWhole);
}

TEST(Histogram, IsEmptyForAnEmptyPicture) {
  const Histogram h = histogram_of({});
  EXPECT_EQ(h.weight(), 0u);
  EXPECT_TRUE(Distribution(h.luminance()).is_empty());
  EXPECT_EQ(Meter(h, {}).shares(0).toe, 0);
}

TEST(Histogram, MeansLogarithmsAsThePixelsDo) {
  const image::Picture picture = scattered(300, 200, 4, 3);
  double sum = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3)
    sum += std::log2(static_cast<double>(luminance_of(std::span<const float, 3>(picture.rgb.data() + i, 3))));
  EXPECT_NEAR(Distribution(histogram_of(picture).luminance()).mean_log2(), sum / 60000, 2e-7);  // a bin's width squared
}

// Shares against a count of the pixels themselves; a bin at a border may fall to the wrong side as a whole.
TEST(Shares, AreThoseOfThePixels) {
  const image::Picture picture = scattered(400, 250, 2.5, 4);
  const Curve curve{0.22, 0.532, 0.001, 0.9};
  const double ev = 0.7, scale = std::exp2(ev);
  Shares want;
  const double each = 1.0 / (400 * 250);
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    const std::span<const float, 3> rgb(picture.rgb.data() + i, 3);
    const double light = scale * static_cast<double>(luminance_of(rgb));
    const double most = scale * static_cast<double>(std::max({rgb[0], rgb[1], rgb[2]}));
    want.zones[static_cast<std::size_t>(std::clamp(std::floor(5.5 + std::log2(light / 0.18)), 0.0, 16.0))] += each;
    (light < 0.22 ? want.toe : light > 0.532 ? want.shoulder : want.linear) += each;
    want.clipped += most >= 0.9 ? each : 0;
    want.crushed += light < 0.001 ? each : 0;
  }
  const Shares got = Meter(histogram_of(picture), curve).shares(ev);
  constexpr double kTolerance =
      4e-4;  // half a bin of 1/1000 stop, where a stop holds at most 0.16 of the pixels; 4 sigma
  for (std::size_t zone = 0; zone < 17; ++zone) EXPECT_NEAR(got.zones[zone], want.zones[zone], kTolerance) << zone;
  EXPECT_NEAR(got.toe, want.toe, kTolerance);
  EXPECT_NEAR(got.linear, want.linear, kTolerance);
  EXPECT_NEAR(got.shoulder, want.shoulder, kTolerance);
  EXPECT_NEAR(got.clipped, want.clipped, kTolerance);
  EXPECT_NEAR(got.crushed, want.crushed, kTolerance);
  EXPECT_NEAR(std::accumulate(got.zones.begin(), got.zones.end(), 0.0), 1, 1e-12);
  EXPECT_NEAR(got.toe + got.linear + got.shoulder, 1, 1e-12);
}

TEST(Shares, OfFewGreysAreExactAtBordersToo) {
  // Light 1 counts as at its grey, whose luminance is 1 to rounding: borders are asked beside it.
  const Meter meter(histogram_of(greys({0, 0.1f, 0.25f, 0.5f, 2, 8, kInfinity, -1})), {0.22, 0.532, 0.15, 1.5});
  const Shares s = meter.shares(0);
  EXPECT_EQ(s.black, 2.0 / 8);
  EXPECT_EQ(s.toe, 3.0 / 8) << "with black";
  EXPECT_EQ(s.linear, 2.0 / 8);
  EXPECT_EQ(s.shoulder, 3.0 / 8);
  EXPECT_EQ(s.clipped, 3.0 / 8);
  EXPECT_EQ(s.crushed, 1.0 / 8) << "without black";
  EXPECT_EQ(s.zones[0], 2.0 / 8);
  EXPECT_EQ(s.zones[16], 1.0 / 8);
}

}  // namespace
}  // namespace likeness::exposure
