#include "olat/view/report_pair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/olat/small_capture.h"

namespace likeness::olat_view {
namespace {

using olat_pair::Pair;
using olat_pair::State;
using testing::HasSubstr;

Pair bumps(int width, int height) {
  Pair out;
  out.photo = test::bump(width, height, 0, 1);
  out.render = test::bump(width, height, 0.4, 0.8);
  out.flaws.assign(static_cast<std::size_t>(width * height), 0);
  return out;
}

TEST(ReportPair, FlipInsideACropIsThatOfTheWholePicture) {
  const Pair pair = bumps(160, 130);
  for (const char* metric : {"flip", "hdr_flip"}) {
    State state;
    state.metric = metric;
    const std::vector<float> whole = olat_pair::flip_map(state, pair);
    for (const Crop& crop : {Crop{60, 50, 20, 30}, Crop{0, 0, 17, 9}, Crop{140, 100, 20, 30}, Crop{0, 0, 160, 130}}) {
      const std::vector<float> inside = flip_inside(state, pair, crop);
      ASSERT_EQ(inside.size(), static_cast<std::size_t>(crop.width * crop.height));
      for (int y = 0; y < crop.height; ++y)
        for (int x = 0; x < crop.width; ++x)
          ASSERT_NEAR(inside[static_cast<std::size_t>(y * crop.width + x)],
                      whole[static_cast<std::size_t>((crop.y + y) * 160 + crop.x + x)], 1e-5)
              << metric << " at " << x << ", " << y << " of the crop at " << crop.x << ", " << crop.y;
    }
  }
}

TEST(ReportPair, CardsLeadToTheirPairAndEscapeItsName) {
  const Pair pair = bumps(40, 30);
  State state;
  state.camera = "a<b>&c";
  state.light = "l 7";
  state.ev = 2;
  const std::vector<float> flip(40 * 30, 0.25f);
  metric::Summary summary;
  summary.p95 = 1.5;
  const std::string card = pair_card(state, pair, {0, 0, 40, 30}, flip, summary);
  EXPECT_THAT(card, HasSubstr("href=\"#camera=a%3Cb%3E%26c&amp;light=l%207\""));
  EXPECT_THAT(card, HasSubstr("<b>a&lt;b&gt;&amp;c, light l 7: 95 % within 1.50 stop</b>"));
  EXPECT_THAT(card, HasSubstr("FLIP, 0 to 1, mean 0.250"));
  EXPECT_THAT(card, HasSubstr("width=\"40\" height=\"30\""));
}

TEST(ReportPair, SmallPicturesAreNoLargerThanTheirSide) {
  const Pair pair = bumps(400, 90);
  const std::vector<float> flip(400 * 90, 0);
  const std::string card = pair_card({}, pair, {0, 0, 400, 90}, flip, {});
  EXPECT_THAT(card, HasSubstr("width=\"134\" height=\"30\"")) << "a third: squares of whole pixels";
}

}  // namespace
}  // namespace likeness::olat_view
