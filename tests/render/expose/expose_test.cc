#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "render/files/files.h"
#include "render/image/read.h"
#include "render/image/tone_curve.h"
#include "render/image/write.h"
#include "tests/olat/small_capture.h"
#include "tests/render/command/process.h"

// `likeness expose`, and what `likeness render` shows of an exposure, from the command line.
namespace likeness::expose {
namespace {

using render_command::test::Ran;
using render_command::test::Workshop;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

image::Picture flat(int width, int height, float light) {
  image::Picture out(width, height);
  for (float& v : out.rgb) v = light;
  return out;
}

class Expose : public testing::Test {
 protected:
  Workshop shop;

  Ran run(Words words, const Words& environment = {}) const {
    words.insert(words.begin(), "expose");
    return shop.run(words, environment);
  }
  Json json(Words words) const {
    words.push_back("--json");
    const Ran ran = run(words);
    EXPECT_EQ(ran.exit_code, 0) << ran.error;
    EXPECT_EQ(ran.error, "");
    return ran.exit_code == 0 ? Json::parse(ran.out) : Json{};
  }
  void expect_refusal(const Words& words, int exit_code, const Words& parts) const {
    const Ran ran = run(words);
    EXPECT_EQ(ran.exit_code, exit_code) << ran.error;
    EXPECT_EQ(ran.out, "");
    EXPECT_EQ(std::count(ran.error.begin(), ran.error.end(), '\n'), 1) << ran.error;
    for (const std::string& part : parts) EXPECT_NE(ran.error.find(part), std::string::npos) << ran.error;
  }
  void write(const std::string& name, const image::Picture& picture) const { image::write_exr(shop / name, picture); }
};

TEST_F(Expose, PrintsTheEvAndWhatItDoesAndWritesNothing) {
  write("a.exr", flat(8, 4, 0.045f));
  const Ran ran = run({"a.exr"});
  EXPECT_EQ(ran.exit_code, 0) << ran.error;
  for (const char* word :
       {"8 x 4", "gt, built in", "EV +2.00", "average", "zone", "XVI", "linear", "percentile", "as it is"})
    EXPECT_NE(ran.out.find(word), std::string::npos) << word << "\n" << ran.out;
  EXPECT_EQ(shop.files(), Words{"a.exr"});
  const Json all = json({"a.exr"});
  EXPECT_NEAR(all.at("ev").get<double>(), 2, 1e-6);
  EXPECT_EQ(all.at("shares").at("zones")[5], 1);
  EXPECT_EQ(all.at("pixels").at("all"), 32);
  EXPECT_TRUE(all.at("ev100").at("taken").is_null());
}

TEST_F(Expose, HasEveryMode) {
  image::Picture card = flat(20, 10, 0.5f);
  for (int y = 2; y < 6; ++y)
    for (int x = 10; x < 14; ++x)
      for (float& v : card.at(x, y)) v = 0.09f;
  write("card.exr", card);
  const auto ev = [&](const Words& more) {
    Words words{"card.exr"};
    words.insert(words.end(), more.begin(), more.end());
    return json(words).at("ev").get<double>();
  };
  EXPECT_NEAR(ev({"--mode", "card", "--patch", "10,2,4,4"}), 1, 1e-6);
  EXPECT_NEAR(ev({"--mode", "patch", "--patch", "10,2,4,4", "--zone", "VI"}), 2, 1e-6);
  EXPECT_NEAR(ev({"--mode", "patch", "--patch", "0,0,4,4", "--zone", "6.5"}), 1.5 - std::log2(0.5 / 0.18), 1e-6);
  EXPECT_NEAR(ev({"--mode", "percentile"}), 1, 1e-6) << "0.5 at light 1";
  EXPECT_NEAR(ev({"--mode", "percentile", "--percentile", "5", "--zone", "V"}), 1, 1e-6);
  EXPECT_EQ(ev({"--ev", "-1.25"}), -1.25);
  const double linear = std::exp2(ev({"--mode", "linear"}));
  EXPECT_GE(linear * 0.5, 0.22);
  EXPECT_LE(linear * 0.5, 0.532);
}

TEST_F(Expose, TakesAMaskWhoseBlackPixelsDoNotCount) {
  image::Picture half = flat(10, 10, 0.18f), mask = flat(10, 10, 1);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 5; ++x)
      for (std::size_t c = 0; c < 3; ++c) half.at(x, y)[c] = y % 2 == 0 ? 1e6f : kNan, mask.at(x, y)[c] = 0;
  write("half.exr", half);
  write("mask.exr", mask);
  const Json all = json({"half.exr", "--mask", "mask.exr"});
  EXPECT_NEAR(all.at("ev").get<double>(), 0, 1e-6);
  EXPECT_EQ(all.at("pixels").at("masked"), 50);
  EXPECT_EQ(all.at("pixels").at("not_number"), 0);
  write("small.exr", flat(3, 3, 1));
  expect_refusal({"half.exr", "--mask", "small.exr"}, 3, {"small.exr: is 3 x 3", "half.exr", "10 x 10"});
}

TEST_F(Expose, IsSafeWithEveryFloatAndWithoutLight) {
  write("dark.exr", flat(4, 4, 0));
  const Json dark = json({"dark.exr", "--page", "dark.html", "--out", "dark.png"});
  EXPECT_EQ(dark.at("ev"), 0);
  EXPECT_EQ(dark.at("shares").at("black"), 1);
  EXPECT_EQ(dark.at("shares").at("crushed"), 0);
  write("one.exr", flat(1, 1, 3e38f));
  EXPECT_LT(json({"one.exr", "--page", "one.html"}).at("ev").get<double>(), -60);
  image::Picture odd(6, 1);
  const std::array<float, 6> light{kNan, kInfinity, -kInfinity, -1, 1e-40f, 0.18f};
  for (std::size_t i = 0; i < 18; ++i) odd.rgb[i] = light[i / 3];
  write("odd.exr", odd);
  for (const char* mode : {"linear", "average", "percentile"})
    for (const char* overlay : {"none", "wedge", "zones", "curve"}) {
      const Json all =
          json({"odd.exr", "--mode", mode, "--overlay", overlay, "--out", "odd.png", "--page", "odd.html"});
      EXPECT_TRUE(std::isfinite(all.at("ev").get<double>()));
      EXPECT_EQ(all.at("pixels").at("not_number"), 1);
      EXPECT_EQ(all.at("pixels").at("infinite"), 2);
      EXPECT_EQ(all.at("pixels").at("denormal"), 1);
    }
}

TEST_F(Expose, GivesASeriesOneEvAndWritesAllOfIt) {
  write("f1.exr", flat(30, 4, 0.09f));
  write("f2.exr", flat(30, 4, 0.36f));
  const Json all = json({"f1.exr", "f2.exr", "--out", "shown", "--overlay", "none", "--view", "srgb"});
  EXPECT_NEAR(all.at("ev").get<double>(), 0, 1e-6);
  EXPECT_EQ(all.at("pictures"), 2);
  EXPECT_EQ(image::read_texels(shop / "shown/f1.png").bytes[0], image::srgb_encode8(0.09f));
  EXPECT_EQ(image::read_texels(shop / "shown/f2.png").bytes[0], image::srgb_encode8(0.36f));
  expect_refusal({"f1.exr", "f2.exr", "--out", "a.png"}, 2, {"2 pictures", "folder"});
}

TEST_F(Expose, TakesAllLightsOfACameraOfACapture) {
  test::write_small_capture(shop / "capture");
  const Json all = json({"capture", "--camera", "c1"});
  EXPECT_EQ(all.at("pictures"), 5);
  EXPECT_GT(json({"capture"}).at("pixels").at("masked").get<int>(), 0) << "the first camera has a mask";
  EXPECT_NE(all.at("name").get<std::string>().find("c1"), std::string::npos);
  EXPECT_EQ(all.at("view").at("name"), "gt") << "of the capture's pipeline";
  expect_refusal({"capture", "--camera", "c9"}, 2, {"--camera", "c9"});
  expect_refusal({"capture", "--mask", "m.exr"}, 2, {"--mask"});
}

TEST_F(Expose, TakesAQuickLookAtAScene) {
  shop.write_ball();
  const Json all = json({"ball.json", "--overlay", "zones", "--out", "z.png"});
  EXPECT_EQ(all.at("size"), (Json{32, 24}));
  EXPECT_EQ(all.at("view").at("name"), "srgb") << "of the scene";
  EXPECT_EQ(json({"ball.json", "--camera", "1"}).at("size"), (Json{24, 32}));
}

TEST_F(Expose, SaysEv100WhereTheCameraIsKnown) {
  write("a.exr", flat(4, 4, 0.09f));
  const Json all = json({"a.exr", "--aperture", "16", "--shutter", "0.008", "--iso", "100"});
  EXPECT_NEAR(all.at("ev100").at("taken").get<double>(), 14.966, 1e-3);
  EXPECT_NEAR(all.at("ev100").at("picked").get<double>(), 13.966, 1e-3) << "a stop more light";
  EXPECT_TRUE(json({"a.exr", "--aperture", "16"}).at("ev100").at("taken").is_null());
}

// A JPEG whose EXIF has two of the facts in its own directory and one in the first, as some cameras write them.
std::string photo_with_exif(const image::DisplayPicture& picture) {
  const auto number = [](std::uint32_t value, int bytes) {
    std::string out;
    for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8 * i)));
    return out;
  };
  const auto row = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t value) {
    return number(tag, 2) + number(type, 2) + number(1, 4) + number(value, 4);
  };
  constexpr std::uint32_t kShort = 3, kLong = 4, kRational = 5;
  // Header 8, first directory 2 + 2 x 12 + 4, EXIF's the same: rationals at 68 and 76.
  std::string tiff = "II" + number(42, 2) + number(8, 4);
  tiff += number(2, 2) + row(34665, kLong, 38) + row(34855, kShort, 100) + number(0, 4);
  tiff += number(2, 2) + row(33434, kRational, 68) + row(33437, kRational, 76) + number(0, 4);
  tiff += number(1, 4) + number(125, 4) + number(160, 4) + number(10, 4);
  const std::string content = std::string("Exif\0\0", 6) + tiff;
  const std::string length{static_cast<char>((content.size() + 2) >> 8), static_cast<char>(content.size() + 2)};
  std::string jpeg = image::jpeg_bytes(picture, 90, image::JpegColors::kYcc);
  return jpeg.insert(2, "\xff\xe1" + length + content);
}

TEST_F(Expose, SaysEv100OfAJpegByItsExif) {
  files::write_whole(shop / "a.jpg", photo_with_exif(image::display(flat(8, 8, 0.09f))));
  EXPECT_NEAR(json({"a.jpg"}).at("ev100").at("taken").get<double>(), 14.966, 1e-3);
  EXPECT_NEAR(json({"a.jpg", "--iso", "200"}).at("ev100").at("taken").get<double>(), 13.966, 1e-3)
      << "by hand goes first";
}

TEST_F(Expose, ShowsWhyOnAPage) {
  write("a<b>.exr", flat(40, 30, 0.09f));
  const Ran ran = run({"a<b>.exr", "--page", "why.html"});
  EXPECT_EQ(ran.exit_code, 0) << ran.error;
  const std::string page = shop.content("why.html");
  for (const char* word : {"Exposure of a&lt;b&gt;.exr", "EV +1.00", "chosen", "percentile", "linear", "as it is",
                           "<svg", "data:image/png", "XVI", "clipped", "crushed"})
    EXPECT_NE(page.find(word), std::string::npos) << word;
  EXPECT_EQ(page.find("a<b>"), std::string::npos);
  EXPECT_EQ(page.find(">nan"), std::string::npos);
}

TEST_F(Expose, ListsViewsAndSaysWhichItUses) {
  const Ran none = run({"--list"}, {"OCIO="});
  EXPECT_EQ(none.exit_code, 0) << none.error;
  EXPECT_NE(none.out.find("No OpenColorIO config"), std::string::npos);
  expect_refusal({"--list", "--ocio", "absent.ocio"}, 3, {"absent.ocio"});
  write("a.exr", flat(4, 4, 0.18f));
  expect_refusal({"a.exr", "--ocio", "a.exr"}, 3, {"a.exr", "OpenColorIO cannot use it"});
  const std::filesystem::path config =
      std::filesystem::path(LIKENESS_SHARED_DIR) / "data/ocio/cg-config-v1.0.0_aces-v1.3_ocio-v2.1.ocio";
  if (!std::filesystem::exists(config)) GTEST_SKIP() << config << " is not there";
  const Ran list = run({"--list"}, {"OCIO=" + config.string()});
  for (const char* word : {"($OCIO)", "--display \"sRGB - Display\"", "--view \"Un-tone-mapped\"", "P3-D65 - Display"})
    EXPECT_NE(list.out.find(word), std::string::npos) << word << list.out;
  EXPECT_EQ(shop.run({"render", "--list-views", "--ocio", config.string()}).out.substr(0, 8), "Built in");
  const Ran used = run({"a.exr"}, {"OCIO=" + config.string()});
  EXPECT_NE(used.out.find("view \"ACES 1.0 - SDR Video\" on \"sRGB - Display\" of "), std::string::npos) << used.out;
  EXPECT_NE(run({"a.exr", "--view", "agx"}, {"OCIO=" + config.string()}).out.find("agx, built in"), std::string::npos);
  expect_refusal({"a.exr", "--ocio", config.string(), "--display", "sRGB"}, 3, {"no display \"sRGB\""});
}

TEST_F(Expose, RefusesInOneLine) {
  write("a.exr", flat(4, 4, 0.18f));
  expect_refusal({}, 2, {"INPUT is required"});
  expect_refusal({"absent.exr"}, 3, {"absent.exr"});
  expect_refusal({"a.exr", "--mode", "avarage"}, 2, {"--mode", "did you mean average?"});
  expect_refusal({"a.exr", "--mode", "card"}, 2, {"needs --patch"});
  expect_refusal({"a.exr", "--mode", "card", "--patch", "1,2,3"}, 2, {"--patch", "X,Y,WIDTH,HEIGHT"});
  expect_refusal({"a.exr", "--mode", "card", "--patch", "2,2,3,3"}, 2, {"do not lie in a.exr, 4 x 4"});
  expect_refusal({"a.exr", "--mode", "card", "--patch", "2147483647,0,2147483647,1"}, 2, {"do not lie in"});
  expect_refusal({"a.exr", "--mode", "percentile", "--zone", "XX"}, 2, {"--zone", "XVI"});
  expect_refusal({"a.exr", "--zone", "V"}, 2, {"--zone is of"});
  expect_refusal({"a.exr", "--ev", "101"}, 2, {"[-100, 100]"});
  expect_refusal({"a.exr", "--ev", "0", "--mode", "linear"}, 2, {"exclude"});
  expect_refusal({"a.exr", "--most-clipped", "nan"}, 2, {"--most-clipped"});
  expect_refusal({"a.exr", "--out", "a.jpg"}, 2, {".png"});
  expect_refusal({"a.exr", "--overlay", "zone", "--out", "a.png"}, 2, {"did you mean zones?"});
  expect_refusal({"a.exr", "--shutter", "0"}, 2, {"--shutter"});
  expect_refusal({"a.exr", "--camera", "c0"}, 2, {"--camera"});
  EXPECT_EQ(shop.files(), Words{"a.exr"});
}

TEST_F(Expose, ShowsZonesOfWhatIsRendered) {
  shop.write_ball();
  const Ran ran =
      shop.run({"render", "ball.json", "--spp", "4", "--expose", "average", "--overlay", "zones", "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.error;
  const image::Texels zones = image::read_texels(shop / "ball.png");
  EXPECT_GT(zones.width, 32) << "the strip of zones";
  EXPECT_GT(zones.height, 24);
  const Json of_picture = json({"ball.exr", "--view", "srgb"});
  EXPECT_EQ(Json::parse(ran.out).at("view").at("ev"), of_picture.at("ev")) << "one implementation";
  const Ran bad = shop.run({"render", "ball.json", "--expose", "card"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_NE(bad.error.find("linear, average, percentile"), std::string::npos) << bad.error;
}

}  // namespace
}  // namespace likeness::expose
