#include "realis/report/leave_one_out.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/realis/domes.h"

namespace likeness::realis {
namespace {

Subject numbered(int width, int height, std::size_t lights) {
  Subject s;
  s.width = width, s.height = height;
  s.to_lights = test::dome(lights);
  for (std::size_t i = 0; i < lights; ++i)
    s.lights.push_back(10 + i), s.irradiance.push_back(1 + static_cast<double>(i));
  for (int p = 0; p < width * height; ++p) {
    s.pixels.push_back(static_cast<std::uint32_t>(p));
    for (std::size_t i = 0; i < lights; ++i) {
      const float value = static_cast<float>(100 * p) + static_cast<float>(i);
      s.photo.push_back({value, value, value}), s.render.push_back({-value, 0, 0});
      s.cosine.push_back(value), s.weight.push_back(1 + value);
    }
  }
  return s;
}

// What is left out is not in memory any more: no later step can look at it.
TEST(LeaveOneOut, ALightThatIsLeftOutIsNowhereInTheSubject) {
  const Subject s = numbered(2, 2, 5);
  const std::vector<std::size_t> left{1, 4};
  const Subject out = without(s, left);
  EXPECT_EQ(out.lights, (std::vector<std::size_t>{10, 12, 13}));
  EXPECT_EQ(out.irradiance, (std::vector<double>{1, 3, 4}));
  ASSERT_EQ(out.photo.size(), 12u);
  for (std::size_t at = 0; at < 12; ++at) {
    const float value = static_cast<float>(100 * (at / 3)) + static_cast<float>(out.lights[at % 3] - 10);
    EXPECT_EQ(out.photo[at][0], value);
    EXPECT_EQ(out.render[at][0], -value);
    EXPECT_EQ(out.cosine[at], value);
    EXPECT_EQ(out.weight[at], 1 + value);
  }
}

TEST(LeaveOneOut, TheGridTakesEveryNthPixel) {
  const Subject out = on_grid(numbered(6, 4, 2), 3);
  EXPECT_EQ(out.pixels, (std::vector<std::uint32_t>{7, 10}));
  EXPECT_EQ(out.photo[2][0], 1000);
  EXPECT_EQ(out.photo.size(), 4u);
}

// 20 log10 of peak over a difference of a tenth; log2 of (0.9 + 0.1) / (0.4 + 0.1) = 1.
TEST(LeaveOneOut, ErrorsAreThoseOfTheirDefinitions) {
  using Color = std::array<float, 3>;
  const std::vector<Color> photo{{0.4f, 0.4f, 0.4f}, {1, 1, 1}}, told{{0.9f, 0.9f, 0.9f}, {9, 9, 9}};
  const std::vector<float> weight{1, 0};
  const Errors e = errors_of(told, photo, weight, 5.0, 0.1);
  EXPECT_NEAR(e.psnr, 20, 1e-4);
  EXPECT_NEAR(e.stops_median, 1, 1e-6);
  EXPECT_NEAR(e.stops_95, 1, 1e-6);
  EXPECT_EQ(errors_of({}, {}, {}, 1, 0.1).psnr, 0);
}

TEST(LeaveOneOut, ABaselineIsBeatenInBothMeasuresAtNoMoreBytesOrNotAtAll) {
  const auto row = [](Family family, std::size_t bytes, double psnr, double stops) {
    Row r;
    r.family = family, r.bytes = bytes, r.errors = {psnr, 0, stops};
    return r;
  };
  Study s;
  s.rows = {row(Family::kBaseline, 20, 30, 0.5), row(Family::kRealis, 21, 40, 0.1), row(Family::kRealis, 20, 40, 0.6),
            row(Family::kRealis, 20, 29, 0.1)};
  EXPECT_EQ(winner_over(s, s.rows[0]), nullptr);
  s.rows.push_back(row(Family::kRealis, 20, 30.1, 0.49));
  EXPECT_EQ(winner_over(s, s.rows[0]), &s.rows[4]);
}

}  // namespace
}  // namespace likeness::realis
