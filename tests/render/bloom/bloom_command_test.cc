#include <unistd.h>

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/bloom/command.h"
#include "render/files/files.h"
#include "render/image/read.h"
#include "render/image/write.h"
#include "tests/render/bloom/small_lamp.h"

namespace likeness::bloom {
namespace {

namespace fs = std::filesystem;

class BloomCommand : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  // What main would end with.
  int run(const std::string& arguments) {
    CLI::App program;
    int exit_code = 0;
    add_bloom(program);
    testing::internal::CaptureStdout();
    try {
      program.parse("bloom " + arguments);
    } catch (const CLI::ParseError&) {
      exit_code = 2;
    } catch (const files::InputError& error) {
      message = error.what(), exit_code = 3;
    }
    out = testing::internal::GetCapturedStdout();
    return exit_code;
  }
  std::string at(const std::string& name) const { return (folder / name).string(); }
  const fs::path folder = fs::path(testing::TempDir()) / ("likeness_bloom_" + std::to_string(::getpid()));
  std::string out, message;
};

TEST_F(BloomCommand, FitsAndAppliesWhatItFitted) {
  const Kernel truth{48, {0.9, 0.9, 0.9}, {{Family::kGaussian, 4, {0.1, 0.1, 0.1}, 0, {}}}};
  const test::Lamp lamp = test::lamp(truth, 49, 0.005, 1e9f);
  image::write_exr(at("lamp.exr"), lamp.source);
  image::write_exr(at("glow.exr"), lamp.glare);
  ASSERT_EQ(run("fit " + at("lamp.exr") + " " + at("glow.exr") + " --components 2 --out " + at("bloom")), 0) << message;
  EXPECT_THAT(out, testing::HasSubstr("gaussian   scale "));
  EXPECT_TRUE(fs::exists(at("bloom/bloom.html")));
  ASSERT_EQ(
      run("apply " + at("lamp.exr") + " " + at("bloom/kernel.json") + " --edges reflect --out " + at("again.exr")), 0)
      << message;
  EXPECT_THAT(out, testing::HasSubstr("light after over before 1"));
  const image::Picture again = image::read_picture(at("again.exr"));
  for (const int x : {24, 28, 32}) EXPECT_NEAR(again.at(x, 24)[0] / lamp.glare.at(x, 24)[0], 1, 0.03) << x;
}

TEST_F(BloomCommand, RefusesWhatItCannotUse) {
  image::write_exr(at("black.exr"), image::Picture(16, 16));
  EXPECT_EQ(run("fit " + at("black.exr") + " " + at("black.exr") + " --out " + at("bloom")), 3);
  EXPECT_THAT(message, testing::HasSubstr("black.exr: is black"));
  EXPECT_FALSE(fs::exists(at("bloom")));
  files::write_whole(at("kernel.json"), "{\"format\": \"likeness bloom\"}");
  EXPECT_EQ(run("apply " + at("black.exr") + " " + at("kernel.json") + " --out " + at("out.exr")), 3);
  EXPECT_THAT(message, testing::HasSubstr("kernel.json:1: \"version\" is missing"));
  EXPECT_EQ(run("apply " + at("black.exr") + " " + at("kernel.json") + " --edges wrap --out x"), 2);
  EXPECT_EQ(run("fit"), 2);
}

}  // namespace
}  // namespace likeness::bloom
