#include "olat/pair/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/image/tone_curve.h"
#include "render/view/view.h"
#include "tests/olat/small_capture.h"
#include "tests/render/temporary_folder.h"

namespace likeness::olat_pair {
namespace {

using test::TemporaryFolder;
using Rgb8 = std::array<int, 3>;

Rgb8 at(const image::DisplayPicture& p, int x, int y) { return {p.at(x, y)[0], p.at(x, y)[1], p.at(x, y)[2]}; }

// One pixel of each.
Pair pair_of(std::array<float, 3> photo, std::array<float, 3> render, std::uint8_t flaws = 0) {
  Pair pair;
  pair.photo = image::Picture(1, 1);
  pair.render = image::Picture(1, 1);
  std::copy(photo.begin(), photo.end(), pair.photo.rgb.begin());
  std::copy(render.begin(), render.end(), pair.render.rgb.begin());
  pair.flaws = {flaws};
  return pair;
}
Rgb8 shown(const std::string& state, const Pair& pair) { return at(picture_of(state_of(state), pair), 0, 0); }
int encoded(double v) { return image::srgb_encode8(static_cast<float>(v)); }

TEST(PictureOfAState, IsThePhotoOrTheRenderThroughOneView) {
  const Pair pair = pair_of({0.2f, 0.1f, 0.05f}, {0.4f, 0.2f, 0.1f});
  EXPECT_EQ(shown("view=srgb", pair), (Rgb8{encoded(0.2), encoded(0.1), encoded(0.05)}));
  EXPECT_EQ(shown("view=srgb&mode=render", pair), (Rgb8{encoded(0.4), encoded(0.2), encoded(0.1)}));
  EXPECT_EQ(shown("view=srgb&ev=1", pair), shown("view=srgb&mode=render", pair));
  EXPECT_EQ(shown("mode=photo&view=gt", pair), at(view::show(pair.photo, {0, "gt", "", ""}), 0, 0));
}

TEST(PictureOfAState, WipesPhotoLeftAndRenderRight) {
  Pair pair;
  pair.photo = image::Picture(4, 1);
  pair.render = image::Picture(4, 1);
  pair.render.rgb.assign(12, 1);
  pair.flaws.assign(4, 0);
  const auto picture = picture_of(state_of("mode=wipe&split=0.75&view=srgb"), pair);
  EXPECT_EQ(picture.rgb, (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255}));
  const auto side = picture_of(state_of("mode=side&view=srgb"), pair);
  EXPECT_EQ(side.width, 8);
  EXPECT_EQ(at(side, 3, 0), (Rgb8{0, 0, 0}));
  EXPECT_EQ(at(side, 4, 0), (Rgb8{255, 255, 255}));
  EXPECT_EQ(at(picture_of(state_of("mode=onion&mix=0.25&view=srgb"), pair), 0, 0), (Rgb8{64, 64, 64}));
}

TEST(PictureOfAState, MapsStopsToOrangeWhereThePhotoIsBrighter) {
  EXPECT_EQ(shown("mode=difference", pair_of({0.4f, 0.4f, 0.4f}, {0.4f, 0.4f, 0.4f})), (Rgb8{41, 41, 43}));
  EXPECT_EQ(shown("mode=difference", pair_of({0.8f, 0.8f, 0.8f}, {0.4f, 0.4f, 0.4f}))[0], 204) << "a stop of two";
  const Rgb8 blue = shown("mode=difference", pair_of({0.1f, 0.1f, 0.1f}, {0.8f, 0.8f, 0.8f}));
  EXPECT_EQ(blue, (Rgb8{168, 224, 255})) << "beyond the end of the colors";
  EXPECT_EQ(shown("mode=difference&range=4", pair_of({0.8f, 0.8f, 0.8f}, {0.2f, 0.2f, 0.2f})),
            shown("mode=difference", pair_of({0.8f, 0.8f, 0.8f}, {0.4f, 0.4f, 0.4f})));
}

TEST(PictureOfAState, LeavesOutWhatTheMaskDoesAndTakesWhatIsNoNumber) {
  EXPECT_EQ(shown("mode=difference", pair_of({1, 1, 1}, {0, 0, 0}, capture::kMasked)), (Rgb8{56, 56, 56}));
  EXPECT_EQ(shown("channel=coverage", pair_of({1, 1, 1}, {0, 0, 0}, capture::kMasked)), (Rgb8{26, 26, 26}));
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(shown("view=srgb", pair_of({kNan, kInfinity, -kInfinity}, {0, 0, 0})), (Rgb8{0, 255, 0}));
  for (const char* metric : {"stops", "signed", "absolute", "smape", "delta_e"})
    EXPECT_NO_THROW(shown(std::string("mode=difference&metric=") + metric, pair_of({kNan, -1, 0}, {kInfinity, 0, 0})));
}

// The colors of maps: dark grey at 0, and their ends at 1 after exposure, whatever the view.
TEST(PictureOfAState, ShowsLightBelowNothingInBlueWhereItsSignIsAskedFor) {
  const auto sign_of = [](float v, const std::string& rest = "") {
    return shown("channel=signed" + rest, pair_of({v, v, v}, {0, 0, 0}));
  };
  EXPECT_EQ(sign_of(0), (Rgb8{41, 41, 43}));
  EXPECT_EQ(sign_of(-1), (Rgb8{168, 224, 255}));
  EXPECT_EQ(sign_of(0.5f, "&view=srgb"), (Rgb8{204, 107, 20}));
  EXPECT_EQ(sign_of(-0.25f, "&ev=1"), sign_of(-0.5f));
  EXPECT_EQ(sign_of(-3), sign_of(-1)) << "beyond the end of the colors";
}

TEST(PictureOfAState, ColorsZonesWithMiddleGreyGrey) {
  EXPECT_EQ(shown("overlay=zones", pair_of({0.18f, 0.18f, 0.18f}, {0, 0, 0})), (Rgb8{118, 118, 118}));
  EXPECT_EQ(shown("overlay=zones&ev=-1", pair_of({0.36f, 0.36f, 0.36f}, {0, 0, 0})), (Rgb8{118, 118, 118}));
  std::set<Rgb8> seen;
  for (int k = -5; k <= 11; ++k) {
    const float v = 0.18f * std::exp2(static_cast<float>(k));
    seen.insert(shown("overlay=zones", pair_of({v, v, v}, {0, 0, 0})));
  }
  EXPECT_EQ(seen.size(), 17u);
}

TEST(PictureOfAState, ColorsTheCurveByTheLiveParameters) {
  const Pair pair = pair_of({0.3f, 0.3f, 0.3f}, {0, 0, 0});
  const Rgb8 line = shown("overlay=curve", pair);
  EXPECT_EQ(line[0], line[2]) << "between m = 0.22 and 0.532: grey";
  const Rgb8 toe = shown("overlay=curve&gt_m=0.4", pair), shoulder = shown("overlay=curve&gt_l=0.05", pair);
  EXPECT_LT(toe[0], toe[2]);
  EXPECT_GT(shoulder[0], shoulder[2]);
  EXPECT_EQ(curve_limits(State{})[0], 0.22);
  EXPECT_NEAR(curve_limits(State{})[1], 0.532, 1e-12);
}

TEST(CurveLimits, OfOtherViewsComeFromTheirSlope) {
  const auto srgb = curve_limits(state_of("view=srgb"));
  EXPECT_EQ(srgb[0], 0) << "the sRGB view has no toe";
  EXPECT_NEAR(srgb[1], 1, 0.05);
  for (const char* name : {"khronos", "agx", "aces"}) {
    const auto limits = curve_limits(state_of(std::string("view=") + name));
    EXPECT_LT(limits[0], 0.18) << name;
    EXPECT_GT(limits[1], 0.18) << name;
    EXPECT_LT(limits[1], 4) << name;
  }
}

TEST(PictureOfAState, StripesWhatIsFull) {
  Pair pair;
  pair.photo = image::Picture(8, 1);
  pair.photo.rgb.assign(24, 0.5f);
  pair.flaws.assign(8, capture::kClipped);
  const auto clipped = picture_of(state_of("zebra=1&view=srgb"), pair);
  EXPECT_EQ(at(clipped, 0, 0), (Rgb8{230, 26, 179}));
  EXPECT_EQ(at(clipped, 5, 0), at(picture_of(state_of("view=srgb"), pair), 5, 0));
  pair.flaws.assign(8, 0);
  EXPECT_EQ(at(picture_of(state_of("zebra=1&view=srgb&ev=4"), pair), 0, 0), (Rgb8{20, 20, 20}));
}

TEST(PictureOfAState, HasAWedgeThatPassesTheView) {
  Pair pair;
  pair.photo = image::Picture(17, 12);
  pair.flaws.assign(17 * 12, 0);
  const auto picture = picture_of(state_of("wedge=1&view=srgb"), pair);
  EXPECT_EQ(at(picture, 5, 11), (Rgb8{118, 118, 118}));
  EXPECT_EQ(at(picture, 4, 11)[0], encoded(0.09));
  EXPECT_EQ(at(picture_of(state_of("wedge=1&view=srgb&ev=1"), pair), 4, 11), (Rgb8{118, 118, 118}));
  EXPECT_EQ(at(picture, 5, 10), (Rgb8{0, 0, 0})) << "a twelfth of the height, at the bottom";
}

TEST(MatchGain, FindsAGainThroughAHighlightThatTheRenderLacks) {
  Pair pair;
  pair.photo = test::bump(64, 48, 0, 1.5);
  pair.render = test::bump(64, 48, 0, 1);
  pair.flaws.assign(64 * 48, 0);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 64; ++x)
      for (float& v : pair.photo.at(x, y)) v += 5;
  EXPECT_NEAR(match_gain(pair, false)[0], 1.5, 0.015) << "a sixth of the pixels are wrong by far";
  for (const double g : match_gain(pair, true)) EXPECT_NEAR(g, 1.5, 0.015);
  pair.render.rgb.assign(pair.render.rgb.size(), 0);
  EXPECT_EQ(match_gain(pair, false)[0], 1) << "a black render has none";
}

TEST(LoadPair, ReadsWhatThereIsAndNamesWhatThereIsNot) {
  const TemporaryFolder folder;
  const capture::Capture capture = test::write_small_capture(folder.path());
  const Pair pair = load_pair(capture, state_of("camera=c0&light=l2&match=light"));
  EXPECT_EQ(pair.width(), 64);
  EXPECT_NEAR(pair.gain[0], std::exp2(0.5), 0.03) << "the render of light 2 is half a stop too dark";
  EXPECT_FLOAT_EQ(pair.noise, 2e-4f);
  EXPECT_TRUE(pair.flaws[0] & capture::kMasked);
  EXPECT_EQ(load_pair(capture, state_of("camera=c0&light=l2")).gain[0], 1) << "none is the default";
  EXPECT_NEAR(load_pair(capture, state_of("light=l2&match=capture")).gain[0], 1, 0.05) << "most lights are right";

  const Pair alone = load_pair(capture, state_of("camera=c1&light=l4"));
  EXPECT_EQ(alone.render.width, 0);
  EXPECT_EQ(picture_of(state_of("mode=render"), alone).at(5, 5)[0], 56) << "the surround";
  EXPECT_NO_THROW(picture_of(state_of("mode=difference&metric=flip"), alone));
  for (const auto& [state, words] : {std::pair{"light=l22", "no light \"l22\"; did you mean l2?"},
                                     std::pair{"camera=zebra", "no camera \"zebra\" (it has 2"}}) {
    try {
      load_pair(capture, state_of(state));
      FAIL() << state;
    } catch (const files::UsageError& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr(words));
    }
  }
}

TEST(FlipMap, IsSeenWhereTheRenderDiffers) {
  Pair pair;
  pair.photo = test::bump(64, 48, 0, 1);
  pair.render = pair.photo;
  pair.flaws.assign(64 * 48, 0);
  for (int y = 10; y < 30; ++y)
    for (int x = 30; x < 50; ++x) pair.render.at(x, y)[0] += 1;
  for (const char* metric : {"flip", "hdr_flip"}) {
    const auto map = flip_map(state_of(std::string("mode=difference&metric=") + metric), pair);
    ASSERT_EQ(map.size(), 64u * 48u);
    EXPECT_GT(map[20 * 64 + 40], 0.1f) << metric;
    EXPECT_LT(map[20 * 64 + 2], 0.01f) << metric;
  }
}

}  // namespace
}  // namespace likeness::olat_pair
