#include "olat/pair/exposure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "render/capture/pixels.h"

namespace likeness::olat_pair {
namespace {

image::Picture greys(const std::vector<float>& values) {
  image::Picture out(static_cast<int>(values.size()), 1);
  for (std::size_t i = 0; i < out.rgb.size(); ++i) out.rgb[i] = values[i / 3];
  return out;
}

TEST(Exposure, PutsTheNinetyNinthOfAHundredPixelsOnWhite) {
  std::vector<float> light(100, 0.01f);
  light[3] = light[7] = 0.0625f;  // ranks 99 and 100
  EXPECT_EQ(exposures_of(greys(light), {}, 1e-4)->percentile, 4);
  light[7] = 1000;  // a highlight of one pixel in a hundred does not count
  EXPECT_EQ(exposures_of(greys(light), {}, 1e-4)->percentile, 4);
  light[3] = 0.01f;
  EXPECT_EQ(exposures_of(greys(light), {}, 1e-4)->percentile, 6.6) << "log2(100) is 6.644, to a tenth";
}

TEST(Exposure, PutsTheMeanOfLogarithmsOnMiddleGrey) {
  EXPECT_EQ(exposures_of(greys({0.09f, 0.36f}), {}, 1e-4)->average, 0);
  EXPECT_EQ(exposures_of(greys({0.045f, 0.045f}), {}, 1e-4)->average, 2);
  EXPECT_FALSE(std::signbit(exposures_of(greys({0.1801f}), {}, 1e-4)->average)) << "0, not -0";
}

TEST(Exposure, LeavesOutWhatIsMaskedNotFiniteOrNoise) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  const std::vector<std::uint8_t> flaws{0, capture::kMasked, capture::kNotFinite, 0, 0, 0};
  const auto found = exposures_of(greys({0.25f, 8, 8, nan, infinite, 5e-5f}), flaws, 1e-4);
  EXPECT_EQ(found->percentile, 2);
  EXPECT_EQ(found->average, -0.5) << "log2(0.18 / 0.25)";
}

TEST(Exposure, OfAPictureBelowTheNoiseFloorTakesWhatThereIs) {
  EXPECT_EQ(exposures_of(greys({-1, 0, 0x1p-20f}), {}, 1e-4)->percentile, 20);
  EXPECT_EQ(exposures_of(greys({1e-30f}), {}, 1e-4)->percentile, 30) << "no further than a state's exposure goes";
}

TEST(Exposure, OfNothingIsNothing) {
  EXPECT_FALSE(exposures_of(image::Picture(), {}, 1e-4));
  EXPECT_FALSE(exposures_of(greys({0, -1, 0}), {}, 1e-4));
  EXPECT_FALSE(exposures_of(greys({1}), std::vector<std::uint8_t>{capture::kMasked}, 1e-4));
}

}  // namespace
}  // namespace likeness::olat_pair
