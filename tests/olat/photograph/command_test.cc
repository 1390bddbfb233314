#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "render/files/files.h"
#include "render/image/layers.h"
#include "render/image/read_exr.h"
#include "render/image/tone_curve.h"
#include "render/image/write.h"
#include "tests/render/command/process.h"

// `likeness hdr merge` and `likeness raw` from the command line.
namespace likeness::olat_photograph {
namespace {

using render_command::test::Ran;
using render_command::test::Workshop;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

constexpr int kWidth = 48, kHeight = 32;

// 8 stops of light from left to right.
float light_at(int x) { return std::exp2(-6.0f + 8.0f * static_cast<float>(x) / kWidth); }

class Photographs : public testing::Test {
 protected:
  Workshop shop;

  // An sRGB photograph of that exposure, 8 bits.
  void write_photo(const std::string& name, float seconds) const {
    image::DisplayPicture out(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          out.at(x, y)[c] = static_cast<std::uint8_t>(
              std::lround(255 * image::srgb_encode(static_cast<double>(std::min(light_at(x) * seconds, 1.0f)))));
    image::write_png(shop / name, out);
  }
  // The same as light that is clipped at 1.
  void write_light(const std::string& name, float seconds) const {
    image::Picture out(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (float& v : out.at(x, y)) v = std::min(light_at(x) * seconds, 1.0f);
    image::write_exr(shop / name, out);
  }
  void expect_light(const std::string& name, double share) const {
    const image::Layers layers = image::read_layers(shop / name);
    const auto main = std::find_if(layers.layers.begin(), layers.layers.end(),
                                   [](const image::Layer& layer) { return layer.name.empty(); });
    ASSERT_NE(main, layers.layers.end());
    for (int x = 2; x < kWidth - 2; ++x)
      EXPECT_NEAR(main->data[static_cast<std::size_t>(3 * (5 * kWidth + x))], light_at(x), share * light_at(x)) << x;
  }
  void expect_refusal(const Words& words, int exit_code, const Words& parts) const {
    const Ran ran = shop.run(words);
    EXPECT_EQ(ran.exit_code, exit_code) << ran.error;
    EXPECT_EQ(ran.out, "");
    EXPECT_EQ(std::count(ran.error.begin(), ran.error.end(), '\n'), 1) << ran.error;
    for (const std::string& part : parts) EXPECT_NE(ran.error.find(part), std::string::npos) << ran.error;
  }
};

TEST_F(Photographs, OfAListBecomeOnePictureWithItsPageAndNumbers) {
  write_photo("a.png", 4), write_photo("b.png", 1), write_photo("c.png", 0.25f);
  files::write_whole(shop / "list.txt", "# name seconds\na.png 4\nb.png, 1\nc.png 1/4\n");
  const Ran ran = shop.run({"hdr", "merge", "--list", "list.txt", "--response", "srgb", "--out", "m.exr", "--page",
                            "m.html", "--response-out", "r.csv", "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.error;
  const Json json = Json::parse(ran.out);
  EXPECT_EQ(json.at("frames").size(), 3u);
  EXPECT_EQ(json.at("width"), kWidth);
  EXPECT_EQ(json.at("clipped_in_all"), 0);
  EXPECT_EQ(shop.files(), (Words{"a.png", "b.png", "c.png", "list.txt", "m.exr", "m.html", "r.csv"}));
  expect_light("m.exr", 0.03);  // codes of 8 bits: a half of 1/255 of 0.2, and less where several frames count
  EXPECT_NE(shop.content("m.html").find("Merged from 3 frames"), std::string::npos);
  // The response that was kept is one that is taken.
  const Ran again = shop.run({"hdr", "merge", "--list", "list.txt", "--response", "r.csv", "--out", "again.exr"});
  EXPECT_EQ(again.exit_code, 0) << again.error;
  expect_light("again.exr", 0.03);
}

TEST_F(Photographs, MayBeOfSeveralKinds) {
  write_photo("a.png", 4), write_light("b.exr", 1), write_light("c.exr", 0.25f);
  const Ran ran = shop.run(
      {"hdr", "merge", "a.png", "b.exr", "c.exr", "--times", "4,1,1/4", "--response", "srgb", "--out", "m.exr"});
  ASSERT_EQ(ran.exit_code, 0) << ran.error;
  expect_light("m.exr", 0.03);
  // Without --out the numbers are all there is.
  const Ran plain = shop.run({"hdr", "merge", "b.exr", "c.exr", "--times", "1,0.25"});
  EXPECT_EQ(plain.exit_code, 0) << plain.error;
  EXPECT_NE(plain.out.find("reference"), std::string::npos) << plain.out;
}

TEST_F(Photographs, ThatCannotBeMergedAreNamed) {
  write_photo("a.png", 1), write_photo("b.png", 2);
  image::write_exr(shop / "small.exr", image::Picture(4, 4));
  expect_refusal({"hdr", "merge", "a.png", "b.png"}, 3, {"a.png", "exposure"});
  expect_refusal({"hdr", "merge", "a.png", "b.png", "--times", "1"}, 2, {"--times", "1", "2"});
  expect_refusal({"hdr", "merge", "a.png", "b.png", "--times", "1,-2"}, 2, {"--times", "-2"});
  expect_refusal({"hdr", "merge", "a.png", "small.exr", "--times", "1,2", "--response", "srgb"}, 3, {"small.exr", "4"});
  expect_refusal({"hdr", "merge", "a.png", "none.png", "--times", "1,2"}, 3, {"none.png"});
  expect_refusal({"hdr", "merge", "--list", "none.txt"}, 3, {"none.txt"});
  expect_refusal({"raw", "a.png", "--out", "x.exr"}, 3, {"a.png"});
  expect_refusal({"raw", "none.dng", "--out", "x.exr"}, 3, {"none.dng"});
  expect_refusal({"hdr", "merge", "a.png", "b.png", "--times", "1,2", "--response", "srgb", "--out", "a.png/m.exr"}, 4,
                 {"a.png"});
  EXPECT_EQ(shop.files(), (Words{"a.png", "b.png", "small.exr"}));
}

TEST_F(Photographs, InterruptedLeaveNothing) {
  image::Picture large(2048, 2048);
  for (float& v : large.rgb) v = 0.5f;
  Words words{"hdr", "merge", "--out", "m.exr", "--times"};
  std::string times;
  Words frames;
  image::write_exr(shop / "f.exr", large);
  for (int i = 0; i < 40; ++i) frames.push_back("f.exr"), times += (i > 0 ? "," : "") + std::to_string(i + 1);
  words.push_back(times);
  words.insert(words.end(), frames.begin(), frames.end());
  const pid_t child = shop.start(words);
  while (render_command::test::cpu_seconds_of(child) < 0.5) usleep(20000);
  kill(child, SIGINT);
  const Ran ran = shop.wait_for(child);
  EXPECT_EQ(ran.exit_code, 130) << ran.error;
  EXPECT_EQ(shop.files(), Words{"f.exr"});
}

// The photograph of a chart that developers share: greys on their reference stops, and the zones of the picture say so.
TEST_F(Photographs, OfAColorCheckerHasItsGreysWhereTheReferenceHasThem) {
  const std::filesystem::path folder = std::filesystem::path(LIKENESS_SHARED_DIR) / "data/colour";
  if (!std::filesystem::exists(folder / "colorchart.dng"))
    GTEST_SKIP() << "no " << folder / "colorchart.dng" << ": it is not part of the repository";
  const Ran ran = shop.run({"raw", folder / "colorchart.dng", "--chart", folder / "data_colorchecker2005.csv",
                            "--zones", "zones.png", "--out", "chart.exr", "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.error;
  const Json json = Json::parse(ran.out);
  const Json& greys = json.at("chart").at("greys");
  ASSERT_EQ(greys.size(), 6u);
  constexpr std::array kAllowed{0.0, 0.02, 0.04, 0.09, 0.17, 0.20};  // [stop], what the photograph itself is off by
  for (std::size_t i = 0; i < greys.size(); ++i)
    EXPECT_LE(std::abs(greys[i].at("error").get<double>()), kAllowed[i] + 5e-4) << greys[i].dump();
  EXPECT_EQ(shop.files(), (Words{"chart.exr", "zones.png"}));
}

}  // namespace
}  // namespace likeness::olat_photograph
