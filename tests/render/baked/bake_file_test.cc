#include "render/baked/bake_file.h"

#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/files/files.h"
#include "tests/realis/domes.h"
#include "tests/render/temporary_folder.h"

namespace likeness::baked {
namespace {

StoredBake some_bake(std::size_t lobes, std::size_t kept, Channels channels) {
  StoredBake s;
  s.width = 7, s.height = 5;
  s.pixels = {0, 3, 8, 20, 34};
  s.about = {"a capture", "c0", {{"photo.exr", "00ff"}}, {{"held_out_rms", 0.25}}};
  s.bake.channels = channels, s.bake.kept = kept, s.bake.floor = 0.3;
  for (const glm::dvec3& axis : realis::test::dome(lobes))
    s.bake.basis.lobes.push_back({axis, 12.5}), s.bake.basis.spread.push_back(3);
  std::mt19937 random(1);
  std::normal_distribution<float> value(0, 0.2f);
  s.bake.coefficients.resize(s.pixels.size() * s.bake.channel_count() * lobes);
  const std::size_t each = s.bake.channel_count() * lobes;
  for (std::size_t i = 0; i < s.bake.coefficients.size(); ++i)
    if (kept == lobes || (i / each + i % lobes) % lobes < kept) s.bake.coefficients[i] = value(random);
  return s;
}

struct Shape {
  std::size_t lobes, kept;
  Channels channels;
};
class BakeFiles : public testing::TestWithParam<Shape> {};

TEST_P(BakeFiles, ComeBackAsEightBitsHoldThem) {
  const likeness::test::TemporaryFolder folder;
  const StoredBake s = some_bake(GetParam().lobes, GetParam().kept, GetParam().channels);
  write_bake(folder.path() / "bake", s, false);
  const StoredBake back = read_bake(folder.path() / "bake");
  EXPECT_EQ(back.pixels, s.pixels);
  EXPECT_EQ(back.about.camera, "c0");
  EXPECT_EQ(back.about.metrics, s.about.metrics);
  EXPECT_EQ(back.bake.kept, s.bake.kept);
  EXPECT_EQ(back.bake.floor, 0.3);
  const Bake expected = quantised(s.bake);
  ASSERT_EQ(back.bake.coefficients.size(), expected.coefficients.size());
  for (std::size_t i = 0; i < expected.coefficients.size(); ++i) {
    EXPECT_FLOAT_EQ(back.bake.coefficients[i], expected.coefficients[i]);
    // Half of a step of the largest coefficient of its lobe, which is at most 1 here.
    EXPECT_NEAR(expected.coefficients[i], s.bake.coefficients[i], 0.5 / 127 + 1e-6);
  }
  for (std::size_t k = 0; k < s.bake.basis.lobes.size(); ++k)
    EXPECT_NEAR(back.bake.basis.lobes[k].axis.x, s.bake.basis.lobes[k].axis.x, 1e-15);
}
TEST_P(BakeFiles, ComeBackToTheBitAsFloats) {
  const likeness::test::TemporaryFolder folder;
  const StoredBake s = some_bake(GetParam().lobes, GetParam().kept, GetParam().channels);
  write_bake(folder.path(), s, false);  // what it leaves behind must not be read
  write_bake(folder.path(), s, true);
  const StoredBake back = read_bake(folder.path());
  const std::size_t each = s.bake.channel_count() * s.bake.basis.lobes.size();
  ASSERT_EQ(back.pixels.size(), 35u);
  for (std::size_t texel = 0; texel < s.pixels.size(); ++texel)
    for (std::size_t k = 0; k < each; ++k)
      EXPECT_EQ(back.bake.coefficients[s.pixels[texel] * each + k], s.bake.coefficients[texel * each + k]);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "coefficients_000.png"));
}
INSTANTIATE_TEST_SUITE_P(Baked, BakeFiles,
                         testing::Values(Shape{1, 1, Channels::kLuminance}, Shape{7, 7, Channels::kRgb},
                                         Shape{20, 8, Channels::kLuminance}, Shape{20, 4, Channels::kRgb}),
                         [](const auto& row) {
                           return std::to_string(row.param.kept) + "Of" + std::to_string(row.param.lobes) +
                                  (row.param.channels == Channels::kRgb ? "Rgb" : "Luminance");
                         });

std::string complaint_of(const std::filesystem::path& folder) {
  try {
    read_bake(folder);
  } catch (const files::InputError& error) {
    return error.what();
  }
  return "nothing";
}
void put(const std::filesystem::path& file, const std::string& from, const std::string& to) {
  std::string text = files::read_whole(file, 1 << 20);
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  files::write_whole(file, text.replace(at, from.size(), to));
}

TEST(BakeFile, WhatIsWrongIsNamed) {
  const likeness::test::TemporaryFolder folder;
  const auto file = folder.path() / "bake.json";
  const auto with = [&](const std::string& from, const std::string& to) {
    write_bake(folder.path(), some_bake(20, 8, Channels::kLuminance), false);
    put(file, from, to);
    return complaint_of(folder.path());
  };
  using testing::HasSubstr;
  EXPECT_THAT(with("\"realis bake\"", "\"cake\""), HasSubstr("cake"));
  EXPECT_THAT(with("\"version\": 1", "\"version\": 2"), HasSubstr("version"));
  EXPECT_THAT(with("\"width\": 7", "\"width\": 8"), HasSubstr("7 x 5"));
  EXPECT_THAT(with("\"width\": 7", "\"width\": 65536"), HasSubstr("65536"));
  EXPECT_THAT(with("\"kept\": 8", "\"kept\": 21"), HasSubstr("more than there are lobes"));
  EXPECT_THAT(with("\"floor\": 0.3", "\"floor\": 0"), HasSubstr("floor"));
  EXPECT_THAT(with("\"sharpness\": 12.5", "\"sharpness\": -1"), HasSubstr("sharpness"));
  EXPECT_THAT(with("\"floor\"", "\"flor\""), HasSubstr("flor"));
  EXPECT_THAT(with("}", ""), HasSubstr("bake.json"));
  write_bake(folder.path(), some_bake(20, 8, Channels::kLuminance), false);
  std::filesystem::remove(folder.path() / "lobes_001.png");
  EXPECT_THAT(complaint_of(folder.path()), HasSubstr("lobes_001.png"));
  EXPECT_THAT(complaint_of(folder.path() / "nowhere"), HasSubstr("bake.json"));
}

// A lobe that bake.json does not have: the pictures of another bake.
TEST(BakeFile, RefusesLobesThatAreNotThere) {
  const likeness::test::TemporaryFolder a, b;
  write_bake(a.path(), some_bake(20, 8, Channels::kLuminance), false);
  write_bake(b.path(), some_bake(10, 8, Channels::kLuminance), false);
  for (const char* name : {"lobes_000.png", "lobes_001.png", "lobes_002.png"})
    std::filesystem::copy_file(a.path() / name, b.path() / name, std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(complaint_of(b.path()), testing::HasSubstr("names lobe"));
}

}  // namespace
}  // namespace likeness::baked
