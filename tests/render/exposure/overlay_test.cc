#include "render/exposure/overlay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "render/exposure/text.h"
#include "render/files/files.h"
#include "render/image/tone_curve.h"
#include "render/view/view.h"
#include "tests/render/exposure/pictures_of_light.h"

namespace likeness::exposure {
namespace {

using test::greys;
using test::kDenormal;
using test::kInfinity;
using test::kNan;
using test::scattered;
using Code = std::array<int, 3>;

Code at(const image::DisplayPicture& p, int x, int y) { return {p.at(x, y)[0], p.at(x, y)[1], p.at(x, y)[2]}; }

image::Picture flat(int width, int height, float light) {
  image::Picture out(width, height);
  for (float& v : out.rgb) v = light;
  return out;
}
const scene::View kSrgb{0, "srgb", "", ""};

TEST(Overlay, LeavesThePictureAsTheViewShowsItUnderTheWedge) {
  const image::Picture light = scattered(600, 40, 3, 1);
  const scene::View view{1, "gt", "", ""};
  const auto plain = view::show(light, view), wedge = picture_with(Overlay::kWedge, light, view);
  EXPECT_EQ(picture_with(Overlay::kNone, light, view).rgb, plain.rgb);
  ASSERT_GT(wedge.height, 40);
  EXPECT_TRUE(std::equal(plain.rgb.begin(), plain.rgb.end(), wedge.rgb.begin())) << "the same width, so the same rows";
}

// The greys are light: exposure, tonemapper and encoding act on them.
TEST(Overlay, HasAWedgeOfLightAStopApartThroughExposureAndView) {
  for (const double ev : {0.0, -2.0})
    for (const char* name : {"srgb", "gt", "agx"}) {
      const scene::View view{ev, name, "", ""};
      const auto wedge = picture_with(Overlay::kWedge, flat(1700, 10, 0.5f), view);
      for (int field = 0; field < 17; ++field) {
        const auto want = view::show(greys({static_cast<float>(0.18 * std::exp2(field - 5))}), view);
        EXPECT_EQ(at(wedge, 100 * field + 50, 15), (Code{want.rgb[0], want.rgb[1], want.rgb[2]})) << name << field;
      }
    }
}

TEST(Overlay, ColorsZonesAndLeavesMiddleGreyGrey) {
  const auto zones = picture_with(Overlay::kZones, flat(600, 4, 0.18f), kSrgb);
  EXPECT_EQ(at(zones, 3, 3), (Code{118, 118, 118}));
  scene::View darker = kSrgb;
  darker.ev = -1;
  EXPECT_EQ(at(picture_with(Overlay::kZones, flat(600, 4, 0.36f), darker), 3, 3), (Code{118, 118, 118}));
}

// What a reader without color sees: neighbors differ in their hatching, and every zone has its numeral.
TEST(Overlay, TellsZonesApartWithoutColor) {
  const auto is_hatched = [](int zone) {
    std::set<float> seen;
    const auto light = static_cast<float>(0.18 * std::exp2(zone - 5));
    for (int x = 0; x < 8; ++x) seen.insert(zone_color(light, x, 0)[1]);
    return seen.size() > 1;
  };
  for (int zone = 0; zone < 16; ++zone) {
    if (zone == 4 || zone == 5) continue;  // IV and V are told apart by V's grey, and by numerals
    EXPECT_NE(is_hatched(zone), is_hatched(zone + 1)) << zone;
  }
  EXPECT_FALSE(is_hatched(5)) << "grey stays grey";

  const auto big = picture_with(Overlay::kZones, flat(640, 60, 0.72f), kSrgb);
  bool has_numeral = false;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 640; ++x) has_numeral |= at(big, x, y) == Code{0, 0, 0};
  EXPECT_TRUE(has_numeral);
}

TEST(Overlay, HatchesToeAndShoulderAcrossEachOther) {
  const std::array<double, 2> limits{0.22, 0.532};
  const DisplayColor grey{0.5f, 0.5f, 0.5f};
  EXPECT_EQ(curve_color(grey, 0.3f, limits, 0, 0), grey);
  EXPECT_EQ(curve_color(grey, 0.3f, limits, 1, 1), grey);
  const auto toe = [&](int x, int y) { return curve_color(grey, 0.1f, limits, x, y); };
  const auto shoulder = [&](int x, int y) { return curve_color(grey, 0.9f, limits, x, y); };
  EXPECT_GT(toe(3, 0)[2], toe(3, 0)[0]) << "bluish";
  EXPECT_GT(shoulder(3, 0)[0], shoulder(3, 0)[2]) << "orange";
  EXPECT_EQ(toe(0, 0), toe(1, 1));
  EXPECT_EQ(toe(5, 5), toe(0, 0)) << "falls";
  EXPECT_EQ(shoulder(0, 0), shoulder(3, 5)) << "rises: 8 is 0";
  EXPECT_NE(toe(0, 0), toe(4, 0));
  EXPECT_NE(shoulder(0, 0), shoulder(4, 0));
  EXPECT_NE(shoulder(2, 2), shoulder(0, 0));
}

TEST(Overlay, ColorsThePartsOfTheViewsOwnCurve) {
  image::Picture light(600, 2);
  for (int x = 0; x < 600; ++x)
    for (int y = 0; y < 2; ++y)
      for (float& v : light.at(x, y)) v = x < 200 ? 0.05f : x < 400 ? 0.3f : 2.0f;
  const auto curve = picture_with(Overlay::kCurve, light, {0, "gt", "", ""});
  EXPECT_LT(at(curve, 100, 0)[0], at(curve, 100, 0)[2]);
  EXPECT_EQ(at(curve, 300, 0)[0], at(curve, 300, 0)[2]);
  EXPECT_GT(at(curve, 500, 0)[0], at(curve, 500, 0)[2]);
  EXPECT_EQ(at(curve, 300, 0)[1], image::srgb_encode8(0.3f)) << "on the line gt is the line";
  const auto up = picture_with(Overlay::kCurve, light, {2, "gt", "", ""});
  EXPECT_GT(at(up, 300, 0)[0], at(up, 300, 0)[2]) << "two stops more are in the shoulder";
}

TEST(Overlay, TakesEveryFloatAndEverySize) {
  for (const OverlayRow& row : kOverlays)
    for (const double ev : {-100.0, 0.0, 100.0})
      for (const char* name : {"gt", "srgb", "khronos", "agx"}) {
        const scene::View view{ev, name, "", ""};
        for (const float v : {kNan, kInfinity, -kInfinity, -1.0f, 0.0f, kDenormal, 3e38f})
          EXPECT_NO_THROW(picture_with(row.overlay, flat(1, 1, v), view)) << row.name << v;
        EXPECT_NO_THROW(picture_with(row.overlay, image::Picture(0, 0), view)) << row.name;
      }
  const auto nan = picture_with(Overlay::kZones, flat(2, 2, kNan), kSrgb);
  EXPECT_EQ(at(nan, 0, 0), (Code{22, 12, 44})) << "no light is in zone 0";
  EXPECT_GE(nan.width, 17 * 24) << "room for labels, beside a picture of 2 x 2";
}

TEST(Overlay, IsFoundByItsName) {
  for (const OverlayRow& row : kOverlays) EXPECT_EQ(overlay_named("--overlay", row.name), row.overlay);
  try {
    overlay_named("--overlay", "zone");
    FAIL();
  } catch (const files::UsageError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean zones?"), std::string::npos) << e.what();
  }
}

TEST(Text, HasALetterForEverythingThatIsWritten) {
  const std::uint64_t box = letter('\1');
  std::set<std::uint64_t> seen{box};
  for (const char c : std::string("0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ+-.,:%<"))
    EXPECT_TRUE(seen.insert(letter(c)).second) << c << " looks like another";
  EXPECT_EQ(letter(' '), 0u);
  EXPECT_EQ(letter('x'), letter('X'));
  EXPECT_EQ(letter('I') >> 30, 0b01110u) << "the top row of I";
}

TEST(Text, IsDrawnWithinThePictureOnly) {
  image::DisplayPicture picture(9, 9);
  draw_text(picture, -3, -3, "88", 1, 255);
  draw_text(picture, 7, 7, "88", 2, 255);
  draw_text(picture, 2, 1, "I", 1, 200);
  EXPECT_EQ(picture.at(4, 1)[0], 200);
  EXPECT_EQ(picture.at(4, 7)[2], 200);
  EXPECT_EQ(text_width("VIII"), 23);
}

TEST(Text, NamesZones) {
  EXPECT_EQ(zone_numeral(16), "XVI");
  for (int zone = 0; zone <= 16; ++zone) EXPECT_EQ(zone_named(zone_numeral(zone)), zone);
  EXPECT_EQ(zone_named("vi"), 6);
  EXPECT_EQ(zone_named("6.5"), 6.5);
  for (const char* no : {"", "IIX", "17", "-1", "nan", "6x", "inf"}) EXPECT_LT(zone_named(no), 0) << no;
}

}  // namespace
}  // namespace likeness::exposure
