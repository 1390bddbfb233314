#include "render/image/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "render/image/flip_steps.h"
#include "render/image/write.h"

namespace likeness::image {
namespace {

using namespace flip_steps;

constexpr double kPpd = FlipOptions{}.pixels_per_degree;

DisplayPicture flat(int width, int height, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  DisplayPicture out(width, height);
  for (std::size_t i = 0; i < out.rgb.size(); i += 3) out.rgb[i] = r, out.rgb[i + 1] = g, out.rgb[i + 2] = b;
  return out;
}

// Bytes of a linear congruential generator (Numerical Recipes), and shapes on a gradient: the inputs of the numbers
// below, which are those of a program of its own: the authors' published numpy listing (NVlabs/flip, python/flip_api.py)
// in double precision, with filters of two dimensions instead of separated ones. Their own test pictures are not here.
DisplayPicture flip_noise(int width, int height, std::uint32_t seed) {
  DisplayPicture out(width, height);
  for (std::uint8_t& v : out.rgb) {
    seed = seed * 1664525u + 1013904223u;
    v = static_cast<std::uint8_t>(seed >> 24);
  }
  return out;
}
DisplayPicture shapes(int shift) {
  const int width = 64, height = 48;
  DisplayPicture out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto p = out.at(x, y);
      p[0] = static_cast<std::uint8_t>(x * 255 / (width - 1));
      p[1] = static_cast<std::uint8_t>(y * 255 / (height - 1));
      p[2] = static_cast<std::uint8_t>((x + y) % 256);
      if (std::abs(x - 20 - shift) < 7 && std::abs(y - 15) < 6) p[0] = 250, p[1] = 240, p[2] = 30;
      if ((x - 45) * (x - 45) + (y - 30) * (y - 30) < 60 + 40 * shift) p[0] = 10, p[1] = 20, p[2] = 200;
    }
  return out;
}
Picture light(const DisplayPicture& picture) {
  Picture out(picture.width, picture.height);
  for (std::size_t i = 0; i < out.rgb.size(); ++i)
    out.rgb[i] = static_cast<float>(std::pow(picture.rgb[i] / 255.0, 6) * 100 + 0.01);
  return out;
}
float at(const ErrorMap& map, int x, int y) { return map.error[static_cast<std::size_t>(y * map.width + x)]; }

TEST(FlipSteps, TurnColorsIntoTheOpponentSpaceAndBack) {
  const Triple white = ycxcz_of_linear({1, 1, 1});
  EXPECT_NEAR(white.x, 100, 1e-4);  // float
  EXPECT_NEAR(white.y, 0, 1e-3);    // 500 times a difference of floats near 1
  EXPECT_NEAR(white.z, 0, 1e-3);    // 200 times one
  const Triple black = ycxcz_of_linear({0, 0, 0});
  EXPECT_EQ(black.x, -16);
  for (const Triple& c : {Triple{0.2f, 0.5f, 0.9f}, Triple{1, 0, 0}, Triple{0, 0, 1}, Triple{0, 0, 0}}) {
    const Triple back = linear_of_ycxcz(ycxcz_of_linear(c));
    EXPECT_NEAR(back.x, c.x, 2e-6);  // float
    EXPECT_NEAR(back.y, c.y, 2e-6);
    EXPECT_NEAR(back.z, c.z, 2e-6);
  }
}

TEST(FlipSteps, AdjustChromaByLightness) {
  // CIELAB of the primaries under D65 (L 87.735, a -86.18, b 83.18 for green; 32.30, 79.19, -107.86 for blue).
  const Triple green = hunt_lab({0, 1, 0}), blue = hunt_lab({0, 0, 1});
  EXPECT_NEAR(green.x, 87.735, 0.01);                // digits of the tables
  EXPECT_NEAR(green.y, 0.87735 * -86.18, 0.03);      // the same
  EXPECT_NEAR(green.z, 0.87735 * 83.18, 0.03);       // the same
  EXPECT_NEAR(blue.x, 32.30, 0.01);                  // the same
  EXPECT_NEAR(blue.y, 0.3230 * 79.19, 0.03);         // the same
  EXPECT_NEAR(blue.z, 0.3230 * -107.86, 0.03);       // the same
  EXPECT_NEAR(hyab(green, blue), 203.301655, 2e-4);  // double precision; floats of 100
  const Triple grey = hunt_lab({0.2f, 0.2f, 0.2f});
  EXPECT_NEAR(grey.y, 0, 1e-4);  // a grey has no chroma; floats
  EXPECT_NEAR(grey.z, 0, 1e-4);
  EXPECT_NEAR(hunt_lab({1, 1, 1}).x, 100, 1e-4);
  EXPECT_NEAR(hunt_lab({0, 0, 0}).x, 0, 1e-5);
}

TEST(FlipSteps, AddLightnessAndChromaSeparately) {
  EXPECT_FLOAT_EQ(hyab({10, 3, 0}, {4, 0, 4}), 6 + 5);
  EXPECT_EQ(hyab({10, 3, 1}, {10, 3, 1}), 0);
}

TEST(FlipSteps, SpreadColorDifferencesOverZeroToOne) {
  EXPECT_EQ(color_difference(0), 0);
  EXPECT_NEAR(color_difference(203.301655f), 1, 1e-6);                                 // the largest; float
  EXPECT_NEAR(color_difference(203.301655f * std::pow(0.4f, 1 / 0.7f)), 0.95, 1e-5);   // the bend; float
  EXPECT_NEAR(color_difference(203.301655f * std::pow(0.2f, 1 / 0.7f)), 0.475, 1e-5);  // half of it
  EXPECT_NEAR(color_difference(100), 0.96738, 1e-5);                                   // black and white
  float before = 0;
  for (float d = 0.01f; d < 203; d *= 1.05f) {
    EXPECT_GT(color_difference(d), before);
    before = color_difference(d);
  }
}

TEST(FlipSteps, HaveContrastFiltersThatSumToOne) {
  for (const double ppd : {1.0, 5.0, kPpd, 300.0})
    for (const Opponent channel : {Opponent::kAchromatic, Opponent::kRedGreen, Opponent::kBlueYellow}) {
      double weights = 0;
      for (const Term& term : contrast_filter(channel, ppd)) {
        EXPECT_NEAR(std::accumulate(term.taps.begin(), term.taps.end(), 0.0), 1, 2e-6);  // floats
        EXPECT_EQ(term.taps.size() % 2, 1u);
        EXPECT_EQ(term.taps.front(), term.taps.back());
        weights += static_cast<double>(term.weight);
      }
      EXPECT_NEAR(weights, 1, 1e-6);  // floats
    }
  // The radius is three deviations of the widest Gaussian, sqrt(0.04 / 2) / pi degrees: 9.05 pixels.
  EXPECT_EQ(contrast_filter(Opponent::kAchromatic, kPpd)[0].taps.size(), 21u);
}

TEST(FlipSteps, HaveABlueYellowFilterOfTwoGaussians) {
  const std::vector<Term> terms = contrast_filter(Opponent::kBlueYellow, kPpd);
  ASSERT_EQ(terms.size(), 2u);
  // Row 10 of the filter of two dimensions, from its definition in double precision.
  const std::vector<double> expected{0.0200005794, 0.0187267372, 0.0153935293, 0.011154425};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    double value = 0;
    for (const Term& t : terms) value += static_cast<double>(t.weight * t.taps[10] * t.taps[10 + i]);
    EXPECT_NEAR(value, expected[i], 1e-8);  // floats of 0.02
  }
}

TEST(FlipSteps, HaveFeatureFiltersThatAnswerOneToAStepAndNothingToAConstant) {
  for (const double ppd : {1.0, 5.0, kPpd, 300.0}) {
    const FeatureFilters f = feature_filters(ppd);
    for (const auto* taps : {&f.edge, &f.point}) {
      double positive = 0, negative = 0;
      for (const float t : *taps) (t > 0 ? positive : negative) += static_cast<double>(t);
      EXPECT_NEAR(positive, 1, 2e-6);   // floats
      EXPECT_NEAR(negative, -1, 2e-6);  // floats
    }
    EXPECT_NEAR(std::accumulate(f.across.begin(), f.across.end(), 0.0), 1, 2e-6);
    const std::size_t middle = f.edge.size() / 2;
    EXPECT_EQ(f.edge[middle], 0);
    EXPECT_GT(f.edge[middle - 1], 0) << "the derivative falls along the row as correlation has it";
    EXPECT_LT(f.point[middle], 0);
    EXPECT_GT(f.point.front(), 0);
  }
  EXPECT_EQ(feature_filters(kPpd).edge.size(), 19u);  // 3 x 2.748 pixels on each side
}

TEST(FlipSteps, HaveAToneCurveThatEndsAtWhite) {
  EXPECT_EQ(tone_curve(0), 0);
  EXPECT_EQ(tone_curve(-1), 0);
  EXPECT_EQ(tone_curve(1e30f), 1);
  EXPECT_NEAR(light_of_tone_085(), 2.1188723239873153, 1e-12);                   // the listing's
  EXPECT_NEAR(tone_curve(static_cast<float>(light_of_tone_085())), 0.85, 1e-6);  // float
  EXPECT_LT(tone_curve(12), 1);
  EXPECT_EQ(tone_curve(15.9f), 1) << "no jump at 16";
}

TEST(Flip, OfEqualPicturesIsZeroEverywhere) {
  const ErrorMap map = flip(flip_noise(40, 30, 3), flip_noise(40, 30, 3));
  EXPECT_EQ(map.mean, 0);
  for (const float e : map.error) EXPECT_EQ(e, 0);
}

TEST(Flip, OfFlatPicturesIsTheColorDifferenceAlone) {
  const auto mean = [](const DisplayPicture& p, const DisplayPicture& q) { return flip(p, q).mean; };
  // The filters' sums cancel to 1e-7 in float, whose root is 3e-4 of a power close to 1.
  EXPECT_NEAR(mean(flat(40, 30, 0, 0, 0), flat(40, 30, 255, 255, 255)), 0.96737976, 2e-4);
  EXPECT_NEAR(mean(flat(40, 30, 0, 255, 0), flat(40, 30, 0, 0, 255)), 1, 2e-4);
  EXPECT_NEAR(mean(flat(40, 30, 100, 100, 100), flat(40, 30, 110, 110, 110)), 0.15346057, 2e-4);
  EXPECT_NEAR(mean(flat(40, 30, 255, 0, 0), flat(40, 30, 250, 5, 3)), 0.12554189, 2e-4);
}

TEST(Flip, IsThatOfTheAuthorsListing) {
  const ErrorMap noisy = flip(flip_noise(40, 30, 1), flip_noise(40, 30, 2));
  EXPECT_NEAR(noisy.mean, 0.43545887751145435, 1e-5);  // float against double, as are all below
  EXPECT_NEAR(at(noisy, 0, 0), 0.7266460932638317, 1e-5);
  EXPECT_NEAR(at(noisy, 39, 29), 0.8500318095593018, 1e-5);
  EXPECT_NEAR(at(noisy, 20, 15), 0.4881735493674012, 1e-5);

  const ErrorMap map = flip(shapes(0), shapes(2));
  EXPECT_NEAR(map.mean, 0.2520439350143007, 2e-5);
  EXPECT_NEAR(at(map, 13, 15), 0.9702354695892793, 1e-5);
  EXPECT_NEAR(at(map, 45, 30), 0.08336267398308221, 1e-4);  // a small feature: the root of a small difference
  EXPECT_NEAR(at(map, 30, 20), 0.43000300282861725, 1e-4);
  EXPECT_EQ(at(map, 0, 0), 0);
}

TEST(Flip, DependsOnTheDistanceAsTheAuthorsListingDoes) {
  EXPECT_NEAR(flip(shapes(0), shapes(2), {20}).mean, 0.14732183797613835, 2e-5);  // float against double
  EXPECT_NEAR(flip(shapes(0), shapes(2), {100}).mean, 0.28569917882620816, 2e-5);
  EXPECT_NEAR(at(flip(shapes(0), shapes(2), {100}), 13, 15), 0.9075064868316688, 1e-5);
}

TEST(Flip, SeesASinglePixel) {
  const DisplayPicture black(21, 21);
  DisplayPicture dot(21, 21);
  dot.at(10, 10)[0] = dot.at(10, 10)[1] = dot.at(10, 10)[2] = 255;
  const ErrorMap map = flip(black, dot);
  EXPECT_NEAR(map.mean, 0.03245255265051192, 2e-6);  // float against double
  EXPECT_NEAR(at(map, 10, 10), 0.8649064759190226, 1e-5);
  EXPECT_NEAR(at(map, 12, 10), 0.4805609060386825, 1e-5);
  EXPECT_EQ(at(map, 0, 0), 0);
}

TEST(Flip, IsSymmetricInItsPicturesAndInItsAxes) {
  const DisplayPicture p = flip_noise(17, 23, 5), q = flip_noise(17, 23, 6);
  EXPECT_EQ(flip(p, q).error, flip(q, p).error);
  const auto transposed = [](const DisplayPicture& in) {
    DisplayPicture out(in.height, in.width);
    for (int y = 0; y < in.height; ++y)
      for (int x = 0; x < in.width; ++x)
        for (std::size_t c = 0; c < 3; ++c) out.at(y, x)[c] = in.at(x, y)[c];
    return out;
  };
  EXPECT_NEAR(flip(p, q).mean, flip(transposed(p), transposed(q)).mean, 1e-5);  // order of float sums
}

TEST(Flip, TakesPicturesSmallerThanItsFilters) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 50}, std::pair{50, 1}, std::pair{3, 2}}) {
    EXPECT_NEAR(flip(flat(width, height, 0, 0, 0), flat(width, height, 255, 255, 255)).mean, 0.96738, 2e-4);
    EXPECT_EQ(flip(flat(width, height, 9, 9, 9), flat(width, height, 9, 9, 9)).mean, 0);
  }
  EXPECT_EQ(flip(DisplayPicture(), DisplayPicture()).mean, 0);
}

TEST(Flip, RefusesWhatItCannotCompare) {
  EXPECT_THROW(flip(DisplayPicture(2, 2), DisplayPicture(2, 3)), std::invalid_argument);
  EXPECT_THROW(hdr_flip(Picture(2, 2), Picture(3, 2)), std::invalid_argument);
  for (const double ppd : {0.0, -1.0, 0.5, 2000.0, std::nan("")})
    EXPECT_THROW(flip(DisplayPicture(2, 2), DisplayPicture(2, 2), {ppd}), std::invalid_argument);
}

TEST(HdrFlip, IsThatOfTheAuthorsListing) {
  const HdrErrorMap map = hdr_flip(light(shapes(0)), light(shapes(2)));
  EXPECT_NEAR(map.start_ev, -5.453323901191371, 1e-5);  // floats
  EXPECT_NEAR(map.stop_ev, -1.4672512121826196, 1e-5);
  EXPECT_EQ(map.exposures, 4);
  EXPECT_NEAR(map.mean, 0.3164541997524753, 2e-5);
  EXPECT_NEAR(at(map, 13, 15), 0.9785446373213684, 1e-5);
  EXPECT_NEAR(at(map, 45, 30), 0.15092835986019323, 1e-4);
}

TEST(HdrFlip, DoesNotDependOnTheUnitOfLight) {
  Picture p = light(shapes(0)), q = light(shapes(2));
  const double mean = hdr_flip(p, q).mean;
  for (Picture* picture : {&p, &q})
    for (float& v : picture->rgb) v *= 1024;
  EXPECT_NEAR(hdr_flip(p, q).mean, mean, 1e-6);  // a power of two: exact but for log2
}

TEST(HdrFlip, StaysFiniteWhereMostIsBlack) {
  Picture reference(64, 48), render(64, 48);
  EXPECT_EQ(hdr_flip(reference, render).mean, 0);
  EXPECT_EQ(hdr_flip(reference, render).exposures, 1);
  reference.at(30, 20)[1] = 5;  // one lit pixel in 3072: the median of all is black
  const HdrErrorMap one = hdr_flip(reference, render);
  EXPECT_TRUE(std::isfinite(one.mean) && std::isfinite(one.stop_ev));
  EXPECT_GT(one.mean, 0);
  EXPECT_EQ(hdr_flip(reference, reference).mean, 0);
  reference.at(31, 20)[1] = 1e-30f;
  reference.at(32, 20)[1] = 1e-30f;
  const HdrErrorMap deep = hdr_flip(reference, render);
  EXPECT_LE(deep.exposures, 24);
  EXPECT_TRUE(std::isfinite(deep.mean));
  const HdrErrorMap black_reference = hdr_flip(Picture(64, 48), reference);
  EXPECT_TRUE(std::isfinite(black_reference.mean));
  EXPECT_GT(black_reference.mean, 0);
}

TEST(HdrFlip, TakesTheMedianOfAllWhereThatIsLit) {
  Picture p(4, 1);  // luminances 0, 1, 4, 16: the median is 2.5
  const std::vector<float> values{0, 1, 4, 16};
  for (int x = 0; x < 4; ++x)
    for (float& v : p.at(x, 0)) v = values[static_cast<std::size_t>(x)];
  const HdrErrorMap map = hdr_flip(p, p);
  EXPECT_NEAR(map.start_ev, std::log2(light_of_tone_085() / 16), 1e-12);  // rounding
  EXPECT_NEAR(map.stop_ev, std::log2(light_of_tone_085() / 2.5), 1e-12);
}

TEST(HdrFlip, TakesTheMedianOfTheLitPixelsWhereMostAreBlack) {
  Picture p(40, 1);
  for (const auto& [x, value] : {std::pair{3, 1.0f}, std::pair{20, 4.0f}, std::pair{30, 16.0f}})
    for (float& v : p.at(x, 0)) v = value;
  const HdrErrorMap map = hdr_flip(p, p);
  EXPECT_NEAR(map.start_ev, std::log2(light_of_tone_085() / 16), 1e-6);  // float luminances
  EXPECT_NEAR(map.stop_ev, std::log2(light_of_tone_085() / 4), 1e-6);
}

TEST(HdrFlip, CountsWhatIsNoNumberAndStaysFinite) {
  Picture reference = light(shapes(0)), render = light(shapes(2));
  reference.rgb[5] = std::numeric_limits<float>::quiet_NaN();
  render.rgb[900] = std::numeric_limits<float>::infinity();
  render.rgb[901] = -std::numeric_limits<float>::infinity();
  render.rgb[902] = -3;
  const HdrErrorMap map = hdr_flip(reference, render);
  EXPECT_EQ(map.not_finite, 3u);
  for (const float e : map.error) ASSERT_TRUE(e >= 0 && e <= 1) << e;
  Picture black_there = reference;
  black_there.rgb[5] = 0;
  render.rgb[901] = render.rgb[902] = 0;
  render.rgb[900] = std::numeric_limits<float>::max();
  EXPECT_EQ(hdr_flip(black_there, render).error, map.error) << "NaN and negative light are black, not left out";
  reference.rgb[6] = std::numeric_limits<float>::infinity();
  for (const float e : hdr_flip(reference, render).error) ASSERT_TRUE(e >= 0 && e <= 1) << e;
}

TEST(ErrorPicture, RunsFromBlackToPaleYellow) {
  const ErrorMap map{5, 1, {0, 1, 0.5f, -1, std::numeric_limits<float>::quiet_NaN()}, 0};
  const DisplayPicture picture = error_picture(map);
  EXPECT_EQ(std::vector<int>(picture.rgb.begin(), picture.rgb.begin() + 6), (std::vector<int>{0, 0, 4, 252, 253, 191}));
  // Magma at 127.5 of 255 is (0.7136, 0.2140, 0.4762).
  EXPECT_NEAR(picture.rgb[6], 182, 2);  // straight lines between every 15th value
  EXPECT_NEAR(picture.rgb[7], 55, 2);
  EXPECT_NEAR(picture.rgb[8], 121, 2);
  for (const std::size_t i : {9u, 12u}) EXPECT_EQ(picture.rgb[i + 2], 4);
  int before = -1;
  for (int k = 0; k <= 255; ++k) {
    const DisplayPicture one = error_picture({1, 1, {static_cast<float>(k) / 255.0f}, 0});
    const int luma = 2126 * one.rgb[0] + 7152 * one.rgb[1] + 722 * one.rgb[2];
    EXPECT_GE(luma + 5000, before) << k;  // half a byte of each channel
    before = luma;
  }
}

}  // namespace
}  // namespace likeness::image
