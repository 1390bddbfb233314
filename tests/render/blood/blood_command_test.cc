#include <unistd.h>

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/blood/command.h"
#include "render/files/files.h"
#include "render/image/layers.h"
#include "render/image/read.h"
#include "render/json/json.h"

namespace likeness::blood {
namespace {

namespace fs = std::filesystem;

class BloodCommand : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  // What main would end with.
  int run(const std::string& arguments) {
    CLI::App program;
    int exit_code = 0;
    add_blood(program);
    testing::internal::CaptureStdout();
    try {
      program.parse("blood " + arguments);
    } catch (const CLI::ParseError&) {
      exit_code = 2;
    } catch (const files::InputError& error) {
      message = error.what(), exit_code = 3;
    }
    out = testing::internal::GetCapturedStdout();
    return exit_code;
  }
  std::string at(const std::string& name) const { return (folder / name).string(); }
  std::string bytes(const std::string& name) const { return files::read_whole(folder / name, 1 << 26); }
  const fs::path folder = fs::path(testing::TempDir()) / ("likeness_blood_" + std::to_string(::getpid()));
  std::string out, message;
};

TEST_F(BloodCommand, MakesATableAndItsPalette) {
  ASSERT_EQ(run("example --out " + at("table.csv")), 0);
  ASSERT_EQ(run("palette " + at("table.csv") + " --width 32 --height 16 --json --out " + at("palette")), 0) << message;
  const json::Value told = json::parse(out, "out");
  EXPECT_LT(told.find("delta_e_2000")->find("left_out")->find("mean")->number, 2.5);
  EXPECT_EQ(told.find("cells")->items.size(), 36u);
  const image::Picture picture = image::read_picture(at("palette/palette.exr"));
  EXPECT_EQ(picture.width, 32);
  EXPECT_GT(picture.at(0, 0)[1], picture.at(31, 0)[1]) << "opacity grows to the right";
  EXPECT_GT(picture.at(28, 0)[0], picture.at(28, 15)[0]) << "time goes downwards";
  EXPECT_THAT(bytes("palette/palette.html"), testing::HasSubstr("Color from the function"));
}

TEST_F(BloodCommand, MakesDecalsOfSpatterTwiceTheSame) {
  const std::string options = "spatter --speed high --distance 0.4 --drops 300 --size 96 --seed 5 --out ";
  ASSERT_EQ(run(options + at("a")), 0);
  ASSERT_EQ(run(options + at("b")), 0);
  for (const std::string name : {"spatter.exr", "spatter.json", "spatter.html", "preview.png", "core.png", "border.png",
                                 "outer_border.png", "mist.png", "drips.png"})
    EXPECT_EQ(bytes("a/" + name), bytes("b/" + name)) << name;
  const image::Layers layers = image::read_layers(at("a/spatter.exr"));
  EXPECT_EQ(layers.layers.size(), 5u);
  ASSERT_NE(layers.find("outer_border"), nullptr);
  EXPECT_EQ(layers.find("outer_border")->channels.size(), 2u);
  const json::Value told = json::parse(bytes("a/spatter.json"), "spatter.json");
  EXPECT_EQ(told.find("thrown")->number, 300);
  EXPECT_GE(told.find("relations")->items.size(), 6u);
}

TEST_F(BloodCommand, RefusesWhatItCannotUse) {
  EXPECT_EQ(run("spatter --angle 4"), 2);
  EXPECT_EQ(run("spatter --speed fast"), 2);
  EXPECT_EQ(run("spatter --size 0"), 2);
  EXPECT_EQ(run("palette " + at("absent.csv")), 3);
  files::write_whole(at("few.csv"), "opacity,time_s,r,g,b\n0.5,0,1,2,3\n");
  EXPECT_EQ(run("palette " + at("few.csv") + " --out " + at("none")), 3);
  EXPECT_THAT(message, testing::HasSubstr("few.csv: has 1 cells"));
  EXPECT_FALSE(fs::exists(at("none")));
}

}  // namespace
}  // namespace likeness::blood
