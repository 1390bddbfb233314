#include "render/photograph/raw.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "olat/photograph/chart_greys.h"
#include "render/files/files.h"
#include "render/image/read.h"

namespace likeness::photograph {
namespace {

namespace fs = std::filesystem;

// A DNG of plain 16-bit numbers, RGGB, black 100, white 1100, that is neutral in (0.5, 1, 0.8).
class Dng {
 public:
  explicit Dng(int width, int height)
      : width_(width), height_(height), counts_(static_cast<std::size_t>(width * height), 600) {}
  std::uint16_t& at(int x, int y) { return counts_[static_cast<std::size_t>(y * width_ + x)]; }

  std::string bytes(int orientation = 1, int white = 1100) const {
    struct Row {
      unsigned tag, type, count;
      std::string value;
    };
    const auto u16 = [](std::initializer_list<int> v) {
      std::string s;
      for (const int x : v) s += static_cast<char>(x & 255), s += static_cast<char>(x >> 8 & 255);
      return s;
    };
    const auto u32 = [](std::initializer_list<int> v) {
      std::string s;
      for (const int x : v)
        for (int k = 0; k < 32; k += 8) s += static_cast<char>(x >> k & 255);
      return s;
    };
    std::string matrix;
    for (int i = 0; i < 9; ++i) matrix += u32({i % 4 == 0 ? 10000 : 1000, 10000});
    const std::string camera("Test Camera\0", 12);
    std::vector<Row> rows{{254, 4, 1, u32({0})},
                          {256, 4, 1, u32({width_})},
                          {257, 4, 1, u32({height_})},
                          {258, 3, 1, u16({16})},
                          {259, 3, 1, u16({1})},
                          {262, 3, 1, u16({32803})},
                          {271, 2, 5, std::string("Test\0", 5)},
                          {272, 2, 12, camera},
                          {273, 4, 1, ""},
                          {274, 3, 1, u16({orientation})},
                          {277, 3, 1, u16({1})},
                          {278, 4, 1, u32({height_})},
                          {279, 4, 1, u32({2 * width_ * height_})},
                          {33421, 3, 2, u16({2, 2})},
                          {33422, 1, 4, std::string("\0\1\1\2", 4)},
                          {33434, 5, 1, u32({1, 50})},
                          {33437, 5, 1, u32({8, 1})},
                          {34855, 3, 1, u16({200})},
                          {50706, 1, 4, std::string("\1\1\0\0", 4)},
                          {50708, 2, 12, camera},
                          {50714, 4, 1, u32({100})},
                          {50717, 4, 1, u32({white})},
                          {50721, 10, 9, matrix},
                          {50728, 5, 3, u32({1, 2, 1, 1, 4, 5})},
                          {50778, 3, 1, u16({21})}};
    const std::size_t start = 8 + 2 + 12 * rows.size() + 4;
    std::string values;
    for (const Row& row : rows)
      if (row.value.size() > 4) values += row.value + std::string(row.value.size() % 2, '\0');
    std::string out("II*\0", 4);
    out += u32({8}) + u16({static_cast<int>(rows.size())});
    std::size_t at = start;
    for (const Row& row : rows) {
      std::string value = row.value;
      if (row.tag == 273) value = u32({static_cast<int>(start + values.size())});
      out += u16({static_cast<int>(row.tag), static_cast<int>(row.type)}) + u32({static_cast<int>(row.count)});
      if (value.size() > 4) out += u32({static_cast<int>(at)}), at += value.size() + value.size() % 2;
      else out += value + std::string(4 - value.size(), '\0');
    }
    out += u32({0}) + values;
    for (const std::uint16_t v : counts_) out += u16({v});
    return out;
  }

 private:
  int width_, height_;
  std::vector<std::uint16_t> counts_;
};

TEST(Demosaic, KeepsConstantsAndRampsAndWhatASiteHas) {
  for (const Pattern& pattern : {Pattern{{{0, 1}, {1, 2}}}, Pattern{{{1, 0}, {2, 1}}}, Pattern{{{2, 1}, {1, 0}}}}) {
    ASSERT_TRUE(is_bayer(pattern));
    std::vector<float> mosaic(12 * 10);
    for (int i = 0; i < 120; ++i) mosaic[static_cast<std::size_t>(i)] = static_cast<float>(3 + 2 * (i % 12) - (i / 12));
    const image::Picture out = demosaic(mosaic, 12, 10, pattern);
    for (int y = 2; y < 8; ++y)
      for (int x = 2; x < 10; ++x)
        for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(out.at(x, y)[c], 3 + 2 * x - y, 1e-5);
  }
  EXPECT_FALSE(is_bayer({{{0, 1}, {2, 1}}}));
}

TEST(Raw, FactsAreThoseOfTheFile) {
  const DngFacts facts = facts_of_dng(Dng(32, 24).bytes(), "a.dng");
  EXPECT_EQ(facts.camera, "Test Camera");
  EXPECT_EQ(facts.black[1][1], 100);
  EXPECT_EQ(facts.white, 1100);
  ASSERT_TRUE(facts.as_shot);
  EXPECT_NEAR((*facts.as_shot)[0], 2, 1e-12);
  EXPECT_NEAR((*facts.as_shot)[2], 1.25, 1e-12);
  EXPECT_EQ(facts.taken.exposure_s, 0.02);
  EXPECT_EQ(facts.taken.f_number, 8);
  EXPECT_EQ(facts.taken.iso, 200);
  for (const auto& row : facts.rec709_from_camera) EXPECT_NEAR(row[0] + row[1] + row[2], 1, 1e-12);
}

TEST(Raw, AGreyOfTheCameraIsGreyAndNoiseBelowBlackStays) {
  Dng dng(32, 24);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x) {
      const double level = x < 16 ? 0.4 : -0.02;
      dng.at(x, y) = static_cast<std::uint16_t>(100 + 1000 * level *
                                                          (y % 2 == 0 && x % 2 == 0   ? 0.5
                                                           : y % 2 == 1 && x % 2 == 1 ? 0.8
                                                                                      : 1));
    }
  const Developed raw = develop(dng.bytes(), "a.dng");
  EXPECT_EQ(raw.clipped, 0u);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(raw.light.at(6, 10)[c], 0.4, 2e-6);
    EXPECT_NEAR(raw.light.at(25, 10)[c], -0.02, 2e-6);
  }
  const Developed sensor = develop(dng.bytes(), "a.dng", {Balance::kNone, {1, 1, 1}, true});
  EXPECT_NEAR(sensor.light.at(6, 10)[0], 0.2, 2e-6);
  EXPECT_NEAR(sensor.light.at(6, 10)[2], 0.32, 2e-6);
}

TEST(Raw, FullSitesAreFlaggedAndWhite) {
  Dng dng(32, 24);
  for (int y = 8; y < 16; ++y)
    for (int x = 8; x < 16; ++x) dng.at(x, y) = 1200;
  const Developed raw = develop(dng.bytes(), "a.dng");
  EXPECT_EQ(raw.clipped, 12u * 12u);  // two sites around, of which the pixels are made too
  EXPECT_EQ(raw.is_clipped[12 * 32 + 12], 1);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(raw.light.at(12, 12)[c], 1, 1e-6);
}

TEST(Raw, IsTurnedUpright) {
  Dng dng(32, 24);
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 16; ++x) dng.at(x, y) = 100;
  const Developed raw = develop(dng.bytes(6), "a.dng",
                                {Balance::kAsShot, {}, true});  // the stored left is the top, the stored top the right
  ASSERT_EQ(raw.light.width, 24);
  ASSERT_EQ(raw.light.height, 32);
  EXPECT_NEAR(raw.light.at(20, 3)[1], 0, 1e-6);
  EXPECT_GT(raw.light.at(3, 3)[1], 0.3f);
}

TEST(Raw, DamagedFilesAreRefused) {
  const std::string whole = Dng(32, 24).bytes();
  EXPECT_THROW(develop("", "a"), files::InputError);
  EXPECT_THROW(develop("II*", "a"), files::InputError);
  for (std::size_t size : {9, 30, 200, 320})
    EXPECT_THROW(develop(whole.substr(0, size), "a"), files::InputError) << size;
  EXPECT_THROW(facts_of_dng(Dng(32, 24).bytes(1, 50), "a"), files::InputError);
  EXPECT_THROW(develop(whole, "a", {Balance::kNone, {}, false}), files::UsageError);
  EXPECT_THROW(develop(whole, "a", {Balance::kGains, {1, 0, 1}, false}), files::UsageError);
}

TEST(Raw, GreysOfARealChartFallOnTheirReferenceStopsAndTheZonePictureSaysSo) {
  const fs::path folder = fs::path(LIKENESS_SHARED_DIR) / "data/colour";
  if (!fs::exists(folder / "colorchart.dng")) GTEST_SKIP() << "no " << folder / "colorchart.dng";
  const std::string name = (folder / "colorchart.dng").string();
  const Developed raw = develop(files::read_whole(name, image::kMostFileBytes), name);
  EXPECT_EQ(raw.facts.black[0][0], 2056);
  EXPECT_EQ(raw.facts.white, 15000);
  const auto reference = olat_calibrate::read_reference(folder / "data_colorchecker2005.csv");
  const olat_photograph::ChartReading reading = olat_photograph::read_chart(raw.light, {}, reference);
  std::printf("%s", olat_photograph::text_of_greys(reading).c_str());
  for (std::size_t i = 0; i < olat_photograph::kGreys; ++i) {
    const olat_photograph::Grey& grey = reading.greys[i];
    EXPECT_LE(std::abs(grey.error), olat_photograph::kGreyLimits[i]) << i;
    // The black patch lies between two zones (2.57), as its reference does (2.47).
    EXPECT_LE(std::abs(grey.shown_zone - grey.expected_zone), i < 5 ? 0.5 : 0.6) << i;
  }
}

}  // namespace
}  // namespace likeness::photograph
