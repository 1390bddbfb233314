#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <CLI/CLI.hpp>

#include "fit/measured/command.h"
#include "fit/measured/convert.h"
#include "fit/measured/csv.h"
#include "fit/measured/merl.h"
#include "render/files/files.h"
#include "tests/fit/measured_files.h"

namespace likeness::measured {
namespace {

namespace fs = std::filesystem;

class Convert : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  const fs::path folder = fs::path(testing::TempDir()) / ("likeness_convert_" + std::to_string(::getpid()));
  const fs::path shared = LIKENESS_SHARED_DIR;
};

TEST_F(Convert, MerlToMerlKeepsEveryBin) {
  files::write_whole(folder / "a.binary", test::small_merl({90, 90, 180}));
  const Conversion c = convert({folder / "a.binary", folder / "b.binary", false});
  EXPECT_FALSE(c.resampled);
  EXPECT_EQ(c.lost, 0u);
  EXPECT_EQ(c.in.valid, c.out.valid);
  EXPECT_LT(c.worst_pct, 1e-10);  // f / scale x scale: two roundings
}

TEST_F(Convert, CsvKeepsSamplesAndTheirWeights) {
  files::write_whole(folder / "a.mbsdf", test::small_mbsdf(8, 9));
  const Conversion c = convert({folder / "a.mbsdf", folder / "a.csv", false});
  EXPECT_EQ(c.out.valid, 8u * 8 * 9);
  EXPECT_EQ(c.lost, 0u);
  EXPECT_LT(c.worst_pct, 1e-4);                          // CSV values and angles are floats
  EXPECT_NEAR(c.directions_out, c.directions_in, 1e-6);  // as are weights
}

TEST_F(Convert, SaysWhatIsLostBetweenTheBins) {
  files::write_whole(folder / "a.mbsdf", test::small_mbsdf(8, 9));
  const Conversion c = convert({folder / "a.mbsdf", folder / "a.binary", false});
  EXPECT_TRUE(c.resampled);
  EXPECT_GT(c.worst_pct, 0.01) << "nearest bins differ from the source between their centres";
  EXPECT_LT(c.median_pct, 5);
  const std::string text = text_of(c, {folder / "a.mbsdf", folder / "a.binary", false});
  EXPECT_THAT(text, testing::HasSubstr("resampled: every bin"));
  EXPECT_THAT(json_of(c, {folder / "a.mbsdf", folder / "a.binary", true}), testing::HasSubstr("\"resampled\": true"));
}

TEST_F(Convert, RefusesOtherExtensionsAndTheInputItself) {
  files::write_whole(folder / "a.csv", test::small_csv());
  EXPECT_THROW(convert({folder / "a.csv", folder / "a.exr", false}), files::UsageError);
  EXPECT_THROW(convert({folder / "a.csv", folder / "." / "a.csv", false}), files::UsageError);
  EXPECT_EQ(files::read_whole(folder / "a.csv", 1000), test::small_csv());
}

TEST_F(Convert, WritesNothingForABadInput) {
  files::write_whole(folder / "a.binary", "short");
  EXPECT_THROW(convert({folder / "a.binary", folder / "b.csv", false}), files::InputError);
  EXPECT_FALSE(fs::exists(folder / "b.csv"));
}

TEST_F(Convert, CommandRunsAndSetsTheExitCode) {
  files::write_whole(folder / "a.mbsdf", test::small_mbsdf());
  CLI::App program;
  int exit_code = -1;
  add_convert(program, exit_code);
  testing::internal::CaptureStdout();
  program.parse("convert --json \"" + (folder / "a.mbsdf").string() + "\" \"" + (folder / "a.csv").string() + "\"");
  EXPECT_THAT(testing::internal::GetCapturedStdout(), testing::HasSubstr("\"compared\": 36"));
  EXPECT_EQ(exit_code, 0);
  EXPECT_THAT(program.get_subcommand("convert")->help(), testing::HasSubstr("theta_i,theta_o,phi,r,g,b[,weight]"));
}

// White A4 paper reflects about 0.84, nearly the same everywhere away from grazing, and reciprocally.
TEST_F(Convert, RealPaperIsWhiteDiffuseAndReciprocal) {
  const fs::path file = shared / "data/materials/rgl/paper_white_rgb.bsdf";
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file << ": the shared data is not beside this checkout";
  const auto paper = read(file);
  for (const double theta_i : {0.1, 0.5, 0.9})
    for (const double theta_o : {0.2, 0.6, 1.0})
      for (const double phi : {0.3, 1.5, 2.6}) {
        Direction l, v;
        directions_at({theta_i, theta_o, phi}, l, v);
        Rgb f, g;
        ASSERT_TRUE(paper->evaluate(l, v, f) && paper->evaluate(v, l, g));
        EXPECT_NEAR(f.g * std::numbers::pi, 0.87, 0.12)
            << theta_i << " " << theta_o << " " << phi;  // 0.779 to 0.967 measured
        EXPECT_NEAR(f.g / g.g, 1, 0.08);  // the data's own: 6.8 % at worst here, 1.6 % in the median of all pairs
      }
}

TEST_F(Convert, RealPaintIsReadAsItsPublishedLayout) {
  const fs::path file = shared / "data/materials/mbsdf/carpaint_blue.mbsdf";
  if (!fs::exists(file)) GTEST_SKIP() << "no " << file << ": the shared data is not beside this checkout";
  const auto paint = read(file);
  EXPECT_EQ(paint->coverage().stored, 45u * 45 * 90);
  EXPECT_EQ(paint->coverage().padding, 45u * 45 * 90 - 34u * 41 * 90) << "theta_in to 68, theta_out to 82 deg are data";
  Direction l, v;
  Rgb mirror, beside;
  directions_at({45 * std::numbers::pi / 180, 45 * std::numbers::pi / 180, std::numbers::pi}, l, v);
  ASSERT_TRUE(paint->evaluate(l, v, mirror));
  directions_at({45 * std::numbers::pi / 180, 45 * std::numbers::pi / 180, std::numbers::pi / 2}, l, v);
  ASSERT_TRUE(paint->evaluate(l, v, beside));
  EXPECT_GT(mirror.g, 100 * beside.g) << "the clear coat's highlight lies at phi = 180 deg";
  EXPECT_GT(beside.b, 2 * beside.r) << "blue";
}

TEST_F(Convert, DecodedMerlTableIsReadWithItsInvalidBins) {
  const fs::path tool = shared / "tools/decode_nbrdf.py";
  if (!fs::exists(tool)) GTEST_SKIP() << "no " << tool << ": the shared data is not beside this checkout";
  if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0)
    GTEST_SKIP() << "no numpy; install python3-numpy";
  const std::string make = "/usr/bin/python3 '" + tool.string() + "' '" + folder.string() + "' yellow-plastic";
  ASSERT_EQ(std::system(make.c_str()), 0);
  const auto table = read(folder / "yellow-plastic.binary");
  EXPECT_EQ(table->coverage().valid, 1096216u) << "75 % of the bins lie above the horizon";
  double albedo = 0;
  table->for_each_sample(
      [&](const Sample& s) { albedo += s.weight * s.f.r * s.to_light.z * s.to_view.z / std::numbers::pi; });
  EXPECT_NEAR(albedo, 0.2803, 1e-3);  // as measured; another scale or weight moves it by far more
}

}  // namespace
}  // namespace likeness::measured
