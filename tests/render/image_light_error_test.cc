#include "render/image/light_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace likeness::image {
namespace {

Picture picture(int width, int height, std::vector<float> rgb) {
  Picture out(width, height);
  out.rgb = std::move(rgb);
  return out;
}

TEST(RelativeMse, OfTwoPixelsIsTheHandComputedOne) {
  const Picture reference = picture(2, 1, {1, 2, 0, 0.1f, 0, 4}), render = picture(2, 1, {1.5f, 2, 0.1f, 0.1f, 0, 3});
  const double expected = (0.25 / 1.01 + 0 + 0.01 / 0.01 + 0 + 0 + 1 / 16.01) / 6;
  const RelativeMse error = relative_mse(reference, render);
  EXPECT_NEAR(error.value, expected, 1e-7);  // 0.1 as a float
  EXPECT_EQ(error.pixels, 2u);
  EXPECT_EQ(error.not_finite, 0u);
  EXPECT_NEAR(relative_mse(reference, render, 1).value, (0.25 / 2 + 0.01 + 1 / 17.0) / 6, 1e-7);
}

TEST(RelativeMse, OfEqualPicturesIsZeroAlsoWhereBlack) {
  EXPECT_EQ(relative_mse(Picture(5, 4), Picture(5, 4)).value, 0);
  EXPECT_EQ(relative_mse(Picture(), Picture()).value, 0);
}

TEST(RelativeMse, LeavesOutAndCountsWhatIsNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const Picture reference = picture(4, 1, {1, 1, 1, nan, 1, 1, 1, 1, 1, 1, 1, 1});
  const Picture render = picture(4, 1, {2, 2, 2, 1, 1, 1, 1, infinity, 1, 1, 1, 1});
  const RelativeMse error = relative_mse(reference, render);
  EXPECT_EQ(error.not_finite, 2u);
  EXPECT_EQ(error.pixels, 2u);
  EXPECT_NEAR(error.value, 0.5 / 1.01, 1e-12);  // rounding
}

TEST(RelativeMse, LooksInsideTheMaskOnly) {
  const Picture reference = picture(3, 1, {1, 1, 1, 1, 1, 1, 1, 1, 1}),
                render = picture(3, 1, {2, 2, 2, 1, 1, 1, NAN, 0, 0});
  const std::vector<std::uint8_t> mask{0, 255, 0};
  const RelativeMse error = relative_mse(reference, render, 0.01, mask);
  EXPECT_EQ(error.value, 0);
  EXPECT_EQ(error.pixels, 1u);
  EXPECT_EQ(error.not_finite, 0u);
  const std::vector<std::uint8_t> none(3, 0);
  EXPECT_EQ(relative_mse(reference, render, 0.01, none).pixels, 0u);
}

TEST(RelativeMse, StaysFiniteForTheLargestFloats) {
  const float largest = std::numeric_limits<float>::max();
  const RelativeMse error = relative_mse(Picture(1, 1), picture(1, 1, {largest, -largest, largest}));
  EXPECT_TRUE(std::isfinite(error.value));
  EXPECT_GT(error.value, 1e70);
}

TEST(ErrorInStops, OfAFactorIsItsLogarithmWhicheverWay) {
  Picture reference(4, 4), brighter(4, 4), darker(4, 4);
  for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
    reference.rgb[i] = 1 + static_cast<float>(i);
    brighter.rgb[i] = 4 * reference.rgb[i];
    darker.rgb[i] = reference.rgb[i] / 8;
  }
  EXPECT_NEAR(error_in_stops(reference, brighter).median, 2, 1e-6);  // float
  EXPECT_NEAR(error_in_stops(reference, brighter).p95, 2, 1e-6);
  EXPECT_NEAR(error_in_stops(reference, darker).median, 3, 1e-6);
}

TEST(ErrorInStops, TakesTheNearestRank) {
  Picture reference(20, 1), render(20, 1);
  for (int x = 0; x < 20; ++x)
    for (std::size_t c = 0; c < 3; ++c) {
      reference.at(x, 0)[c] = 1;
      render.at(x, 0)[c] = std::exp2(static_cast<float>(x + 1));  // errors 1, 2, ..., 20 stops
    }
  const StopsError error = error_in_stops(reference, render);
  EXPECT_NEAR(error.median, 10, 1e-6);
  EXPECT_NEAR(error.p95, 19, 1e-6);
  EXPECT_EQ(error.pixels, 20u);
  const StopsError three = error_in_stops(picture(1, 1, {1, 1, 1}), picture(1, 1, {2, 16, 4}));  // 1, 4 and 2 stops
  EXPECT_NEAR(three.median, 2, 1e-6);                                                            // the second of three
  EXPECT_NEAR(three.p95, 4, 1e-6);
}

TEST(ErrorInStops, LiftsWhatIsDarkToTheFloor) {
  const Picture reference = picture(2, 1, {0, 0, 0, 2, 2, 2}), render = picture(2, 1, {-1, 1e-30f, 0, 2, 2, 2});
  const StopsError error = error_in_stops(reference, render);
  EXPECT_NEAR(error.floor, 1e-3, 1e-9);  // of the mean, 1
  EXPECT_EQ(error.p95, 0);
  EXPECT_NEAR(error_in_stops(reference, picture(2, 1, {1, 1, 1, 2, 2, 2})).p95, std::log2(1000), 1e-4);  // float
}

TEST(ErrorInStops, OfBlackPicturesIsZeroAndOfABlackReferenceFinite) {
  EXPECT_EQ(error_in_stops(Picture(3, 3), Picture(3, 3)).p95, 0);
  const StopsError error = error_in_stops(Picture(1, 1), picture(1, 1, {1, 1, 1}));
  EXPECT_NEAR(error.median, 126, 1e-3);  // to the smallest normal float
  EXPECT_EQ(error_in_stops(Picture(), Picture()).pixels, 0u);
}

TEST(ErrorInStops, CountsWhatIsNotFiniteAndLooksInsideTheMask) {
  const Picture reference = picture(3, 1, {1, 1, 1, 1, 1, 1, 1, 1, 1}),
                render = picture(3, 1, {2, 2, 2, NAN, 1, 1, 8, 8, 8});
  EXPECT_EQ(error_in_stops(reference, render).not_finite, 1u);
  const std::vector<std::uint8_t> mask{1, 1, 0};
  const StopsError error = error_in_stops(reference, render, 1e-3, mask);
  EXPECT_NEAR(error.p95, 1, 1e-6);
  EXPECT_EQ(error.pixels, 1u);
}

TEST(LightErrors, RefuseWhatTheyCannotCompare) {
  EXPECT_THROW(relative_mse(Picture(2, 2), Picture(2, 3)), std::invalid_argument);
  EXPECT_THROW(relative_mse(Picture(1, 1), Picture(1, 1), 0), std::invalid_argument);
  EXPECT_THROW(relative_mse(Picture(1, 1), Picture(1, 1), NAN), std::invalid_argument);
  EXPECT_THROW(error_in_stops(Picture(1, 1), Picture(1, 1), 0), std::invalid_argument);
  const std::vector<std::uint8_t> mask(3, 1);
  EXPECT_THROW(relative_mse(Picture(2, 2), Picture(2, 2), 0.01, mask), std::invalid_argument);
  EXPECT_THROW(error_in_stops(Picture(2, 2), Picture(2, 2), 1e-3, mask), std::invalid_argument);
}

}  // namespace
}  // namespace likeness::image
