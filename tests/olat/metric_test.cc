#include "olat/metric/metric.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "olat/metric/formulas.h"
#include "render/files/files.h"
#include "render/image/tone_curve.h"

namespace likeness::metric {
namespace {

using image::DisplayPicture;
using image::Picture;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kLargest = std::numeric_limits<float>::max();

// Table 1 of Sharma, Wu and Dalal 2005: L a b, L a b, Delta E to four digits.
constexpr std::array<std::array<double, 7>, 34> kSharma{{
    {50, 2.6772, -79.7751, 50, 0, -82.7485, 2.0425},
    {50, 3.1571, -77.2803, 50, 0, -82.7485, 2.8615},
    {50, 2.8361, -74.0200, 50, 0, -82.7485, 3.4412},
    {50, -1.3802, -84.2814, 50, 0, -82.7485, 1.0000},
    {50, -1.1848, -84.8006, 50, 0, -82.7485, 1.0000},
    {50, -0.9009, -85.5211, 50, 0, -82.7485, 1.0000},
    {50, 0, 0, 50, -1, 2, 2.3669},
    {50, -1, 2, 50, 0, 0, 2.3669},
    {50, 2.4900, -0.0010, 50, -2.4900, 0.0009, 7.1792},
    {50, 2.4900, -0.0010, 50, -2.4900, 0.0010, 7.1792},
    {50, 2.4900, -0.0010, 50, -2.4900, 0.0011, 7.2195},
    {50, 2.4900, -0.0010, 50, -2.4900, 0.0012, 7.2195},
    {50, -0.0010, 2.4900, 50, 0.0009, -2.4900, 4.8045},
    {50, -0.0010, 2.4900, 50, 0.0010, -2.4900, 4.8045},
    {50, -0.0010, 2.4900, 50, 0.0011, -2.4900, 4.7461},
    {50, 2.5, 0, 50, 0, -2.5, 4.3065},
    {50, 2.5, 0, 73, 25, -18, 27.1492},
    {50, 2.5, 0, 61, -5, 29, 22.8977},
    {50, 2.5, 0, 56, -27, -3, 31.9030},
    {50, 2.5, 0, 58, 24, 15, 19.4535},
    {50, 2.5, 0, 50, 3.1736, 0.5854, 1.0000},
    {50, 2.5, 0, 50, 3.2972, 0, 1.0000},
    {50, 2.5, 0, 50, 1.8634, 0.5757, 1.0000},
    {50, 2.5, 0, 50, 3.2592, 0.3350, 1.0000},
    {60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644},
    {63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630},
    {61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731},
    {35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645},
    {22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373},
    {36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146},
    {90.8027, -2.0831, 1.4410, 91.1528, -1.6435, 0.0447, 1.4441},
    {90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381},
    {6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377},
    {2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082},
}};

Picture picture_of(int width, int height, const std::vector<float>& rgb) {
  Picture picture(width, height);
  picture.rgb = rgb;
  return picture;
}
Picture flat(int width, int height, float value) {
  Picture picture(width, height);
  std::fill(picture.rgb.begin(), picture.rgb.end(), value);
  return picture;
}
Picture noise_picture(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> light(0.0f, 1.0f);
  Picture picture(width, height);
  for (float& v : picture.rgb) v = light(random);
  return picture;
}

struct Shown {
  DisplayPicture photo, render;
};
Pair pair_of(const Picture& photo, const Picture& render, Shown& shown) {
  shown = {image::display(photo), image::display(render)};
  return {.photo = &photo, .render = &render, .shown_photo = &shown.photo, .shown_render = &shown.render};
}

TEST(DeltaE, AgreesWithThePairsThatItsAuthorsPublished) {
  for (const auto& row : kSharma) {
    const image::Lab p{row[0], row[1], row[2]}, q{row[3], row[4], row[5]};
    EXPECT_NEAR(delta_e_2000(p, q), row[6], 0.5e-4 + 1e-9) << row[0] << " " << row[1] << " " << row[2];  // its digits
    EXPECT_NEAR(delta_e_2000(q, p), row[6], 0.5e-4 + 1e-9) << "the other way round";
  }
}

TEST(DeltaE, OfWhiteAndBlackIsAHundredAndOfEqualColorsNothing) {
  const image::Lab white = image::lab_of_rec709({1, 1, 1}), black = image::lab_of_rec709({0, 0, 0});
  EXPECT_NEAR(white.l, 100, 1e-9);
  EXPECT_NEAR(std::hypot(white.a, white.b), 0, 1e-9);
  EXPECT_NEAR(black.l, 0, 1e-12);
  EXPECT_NEAR(delta_e_2000(white, black), 100, 1e-6);  // SL is 1 at a mean L of 50
  EXPECT_EQ(delta_e_2000(white, white), 0);
}

TEST(Stops, OfTwiceTheLightIsOneAndOfNoiseOverNoiseNothing) {
  EXPECT_NEAR(stops(0.5f, 0.25f, 1e-6f), 1, 1e-5f);
  EXPECT_NEAR(stops(0.25f, 0.5f, 1e-6f), -1, 1e-5f);
  EXPECT_FLOAT_EQ(stops(3, 1, 1), 1) << "(3 + 1) / (1 + 1)";
  EXPECT_EQ(stops(-0.2f, 0, 0.1f), 0) << "negative light is black";
  EXPECT_EQ(stops(-0.2f, -7, 0.1f), 0);
  EXPECT_LT(std::abs(stops(1e-5f, 5e-5f, 1e-2f)), 0.01f) << "both far below the noise";
}

TEST(Formulas, AreFiniteAtTheEndsOfFloat) {
  for (const float p : {0.0f, -0.0f, 1e-38f, -1e30f, 1e30f, kLargest / 4})
    for (const float r : {0.0f, 1e-38f, -1e30f, 1e30f, kLargest / 4})
      for (const float n : {kLeastNoise, 1e-4f}) {
        EXPECT_TRUE(std::isfinite(stops(p, r, n))) << p << " " << r << " " << n;
        EXPECT_TRUE(smape(p, r, n) >= 0 && smape(p, r, n) <= 2) << p << " " << r << " " << n;
      }
  EXPECT_EQ(stops(0, 0, kLeastNoise), 0);
  EXPECT_FLOAT_EQ(smape(3, 1, 0.5f), 0.8f) << "2 * 2 / (3 + 1 + 1)";
  EXPECT_FLOAT_EQ(smape(-1, 1, kLeastNoise), 2);
}

TEST(Metric, HandValuesOfEveryMapOfLight) {
  const Picture photo = picture_of(1, 1, {0.5f, 0.25f, -0.1f}), render = picture_of(1, 1, {0.25f, 0.25f, 0.1f});
  const Pair pair{.photo = &photo, .render = &render, .noise_floor = {1e-9f, 1e-9f, 0.1f}};
  const Map in_stops = map_of(Metric::kStops, pair);
  EXPECT_NEAR(in_stops.values[0], 1, 1e-5);
  EXPECT_EQ(in_stops.values[1], 0);
  EXPECT_NEAR(in_stops.values[2], -1, 1e-6) << "(0 + 0.1) / (0.1 + 0.1)";
  EXPECT_EQ(map_of(Metric::kSigned, pair).values, (std::vector<float>{0.25f, 0, -0.2f}));
  EXPECT_EQ(map_of(Metric::kAbsolute, pair).values, (std::vector<float>{0.25f, 0, 0.2f}));
  const Map relative = map_of(Metric::kSmape, pair);
  EXPECT_NEAR(relative.values[0], 2 * 0.25 / 0.75, 1e-6);
  EXPECT_NEAR(relative.values[2], 2 * 0.2 / (0.2 + 0.2), 1e-6);
}

TEST(Metric, DeltaEIsThatOfWhatIsShown) {
  const Picture photo = flat(2, 2, 1), render = flat(2, 2, 0);
  Shown shown;
  const Pair pair = pair_of(photo, render, shown);
  EXPECT_NEAR(map_of(Metric::kDeltaE, pair).values[3], 100, 1e-4);
  // Twice as bright as white is shown as white.
  const Picture brighter = flat(2, 2, 2);
  const Pair clipped = pair_of(photo, brighter, shown);
  EXPECT_EQ(summary_of(map_of(Metric::kDeltaE, clipped), {}).largest, 0);
  EXPECT_NEAR(summary_of(map_of(Metric::kStops, clipped), {}).mean, -1, 1e-3);
}

TEST(Metric, EqualPicturesAreEqualInEveryMetric) {
  const Picture photo = noise_picture(37, 23, 1);
  Shown shown;
  const Pair pair = pair_of(photo, photo, shown);
  for (std::size_t k = 0; k < kMetrics.size(); ++k) {
    const Map map = map_of(static_cast<Metric>(k), pair);
    EXPECT_EQ(map.channels, kMetrics[k].channels);
    const Summary summary = summary_of(map, {});
    EXPECT_EQ(summary.largest, 0) << kMetrics[k].id;
    EXPECT_EQ(summary.pixels, 37u * 23u) << kMetrics[k].id;
  }
}

TEST(Metric, AFaultIsSeenByEveryMetricWithItsSign) {
  const Picture photo = flat(16, 16, 0.4f), render = flat(16, 16, 0.2f);
  Shown shown;
  const Pair pair = pair_of(photo, render, shown);
  for (std::size_t k = 0; k < kMetrics.size(); ++k) {
    const Summary summary = summary_of(map_of(static_cast<Metric>(k), pair), {});
    EXPECT_GT(summary.mean, 0.01) << kMetrics[k].id;
    const Pair swapped{
        .photo = pair.render, .render = pair.photo, .shown_photo = pair.shown_render, .shown_render = pair.shown_photo};
    const double other = summary_of(map_of(static_cast<Metric>(k), swapped), {}).mean;
    EXPECT_EQ(other < 0, kMetrics[k].is_signed) << kMetrics[k].id;
  }
}

TEST(Metric, FlipIsThatOfTheImageRoomInsideTheMaskOnly) {
  const Picture photo = noise_picture(48, 32, 2), render = noise_picture(48, 32, 3);
  Shown shown;
  Pair pair = pair_of(photo, render, shown);
  const image::ErrorMap whole = image::flip(shown.photo, shown.render);
  EXPECT_EQ(map_of(Metric::kFlip, pair).values, whole.error);
  // The left half differs nowhere; what the right half holds must not be seen from there.
  Picture half = photo;
  std::vector<float> weight(photo.rgb.size() / 3);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 48; ++x) {
      weight[static_cast<std::size_t>(48 * y + x)] = x < 24 ? 1.0f : 0.0f;
      if (x >= 24) half.at(x, y)[0] = 0.9f;
    }
  pair = pair_of(photo, half, shown);
  EXPECT_GT(summary_of(map_of(Metric::kFlip, pair), weight).largest, 0.01) << "without the weights it is";
  pair.weight = weight;
  for (const Metric metric : {Metric::kFlip, Metric::kHdrFlip})
    EXPECT_EQ(summary_of(map_of(metric, pair), weight).largest, 0) << row_of(metric).id;
}

TEST(Metric, HdrFlipOfAMostlyBlackPhotoIsFiniteAndTakesTheStatedExposures) {
  Picture photo(64, 64), render(64, 64);
  for (int x = 30; x < 34; ++x) photo.at(x, 30)[1] = 3.0f, render.at(x, 30)[1] = 2.0f;
  Pair pair{.photo = &photo, .render = &render};
  const Map map = map_of(Metric::kHdrFlip, pair);
  for (const float v : map.values) ASSERT_TRUE(v >= 0 && v <= 1) << v;
  EXPECT_GT(summary_of(map, {}).largest, 0.05);
  const image::HdrErrorMap own = image::hdr_flip_over({-4, 3}, photo, render);
  EXPECT_EQ(own.exposures, 7);
  EXPECT_EQ(own.start_ev, -4);
  EXPECT_EQ(own.stop_ev, 3);
  EXPECT_EQ(map.values, own.error);
  pair.exposures = {-20, -19};
  EXPECT_LT(summary_of(map_of(Metric::kHdrFlip, pair), {}).largest, 0.05) << "at 20 stops less there is nothing to see";
  EXPECT_THROW(image::hdr_flip_over({3, -4}, photo, render), std::invalid_argument);
  EXPECT_THROW(image::hdr_flip_over({0, kInfinity}, photo, render), std::invalid_argument);
}

TEST(Summary, WeighsEachPixel) {
  Map map{4, 1, 1, {-1, 2, 3, -10}};
  const Summary plain = summary_of(map, {});
  EXPECT_DOUBLE_EQ(plain.mean, -1.5);
  EXPECT_DOUBLE_EQ(plain.median, -1) << "nearest rank: the second of four";
  EXPECT_DOUBLE_EQ(plain.p95, 10);
  EXPECT_DOUBLE_EQ(plain.rms, std::sqrt(114.0 / 4));
  EXPECT_DOUBLE_EQ(plain.largest, 10);
  const std::vector<float> weight{1, 1, 2, 0};
  const Summary weighted = summary_of(map, weight);
  EXPECT_DOUBLE_EQ(weighted.mean, 1.75) << "(-1 + 2 + 6) / 4";
  EXPECT_DOUBLE_EQ(weighted.median, 2);
  EXPECT_DOUBLE_EQ(weighted.p95, 3);
  EXPECT_DOUBLE_EQ(weighted.rms, std::sqrt(23.0 / 4));
  EXPECT_EQ(weighted.pixels, 3u);
  // Weights that are all equal take another way to the quantiles.
  EXPECT_DOUBLE_EQ(summary_of(map, std::vector<float>(4, 0.3f)).median, plain.median);
}

TEST(Summary, LeavesOutAndCountsWhatIsNotFinite) {
  Picture photo = flat(3, 1, 0.5f), render = flat(3, 1, 0.5f);
  photo.at(1, 0)[2] = kNaN;
  render.at(2, 0)[0] = kInfinity;
  Shown shown;
  const Pair pair = pair_of(photo, render, shown);
  for (const MetricRow& row : kMetrics) {
    if (row.id == "delta_e") continue;  // of display values, which are all finite
    const Summary summary = summary_of(map_of(metric_of(row.id), pair), {});
    EXPECT_EQ(summary.pixels, 1u) << row.id;
    EXPECT_EQ(summary.not_finite, 2u) << row.id;
    EXPECT_EQ(summary.largest, 0) << row.id;
  }
  const std::vector<float> first{1, 0, 0};
  EXPECT_EQ(summary_of(map_of(Metric::kStops, pair), first).not_finite, 0u) << "nobody asked for those pixels";
}

TEST(Summary, OfNothingIsZero) {
  EXPECT_EQ(summary_of(Map{}, {}).pixels, 0u);
  const Map one{1, 1, 3, {1, 2, 3}};
  EXPECT_EQ(summary_of(one, std::vector<float>{0}).largest, 0);
  EXPECT_EQ(summary_of(one, std::vector<float>{1}).median, 2);
  const Picture empty;
  const Pair pair{.photo = &empty, .render = &empty};
  for (const Metric metric : {Metric::kStops, Metric::kHdrFlip}) EXPECT_TRUE(map_of(metric, pair).values.empty());
}

// +0.50 EV planted in a picture with the noise of a camera: read noise and the noise of counting photons.
TEST(Summary, FindsHalfAStopUnderNoise) {
  constexpr float kRead = 2e-3f;
  std::mt19937 random(11);
  std::normal_distribution<float> normal;
  const Picture render = noise_picture(200, 200, 12);
  Picture photo = render;
  for (float& v : photo.rgb) {
    v *= std::exp2(0.5f);
    v += normal(random) * std::sqrt(kRead * kRead + 1e-4f * v);
  }
  const Pair pair{.photo = &photo, .render = &render, .noise_floor = {kRead, kRead, kRead}};
  const Summary summary = summary_of(map_of(Metric::kStops, pair), {});
  EXPECT_NEAR(summary.median, 0.5, 0.02);
  EXPECT_NEAR(summary.mean, 0.5, 0.05) << "light near the noise pulls the mean towards 0";
}

TEST(Metric, RefusesPicturesOfOtherSizesAndUnknownNames) {
  const Picture photo = flat(4, 4, 1), render = flat(4, 5, 1);
  EXPECT_THROW(map_of(Metric::kStops, Pair{.photo = &photo, .render = &render}), std::invalid_argument);
  EXPECT_THROW(map_of(Metric::kStops, Pair{.photo = &photo}), std::invalid_argument);
  EXPECT_THROW(map_of(Metric::kFlip, Pair{.photo = &photo, .render = &photo}), std::invalid_argument);
  const std::vector<float> short_weight(3, 1.0f);
  EXPECT_THROW(map_of(Metric::kStops, Pair{.photo = &photo, .render = &photo, .weight = short_weight}),
               std::invalid_argument);
  EXPECT_THROW(summary_of(Map{2, 2, 1, {1, 2, 3, 4}}, short_weight), std::invalid_argument);
  for (const MetricRow& row : kMetrics) EXPECT_EQ(row_of(metric_of(row.id)).id, row.id);
  try {
    metric_of("stop");
    FAIL();
  } catch (const files::UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean stops?"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace likeness::metric
