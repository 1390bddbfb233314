#include <unistd.h>

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fit/film/command.h"
#include "render/files/files.h"
#include "render/json/json.h"
#include "render/material/material_file.h"

namespace likeness::film {
namespace {

namespace fs = std::filesystem;

class FilmCommand : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  // What main would end with.
  int run(const std::string& arguments) {
    CLI::App program;
    int exit_code = 0;
    add_film(program, exit_code);
    testing::internal::CaptureStdout();
    try {
      program.parse("film " + arguments);
    } catch (const CLI::ParseError&) {
      exit_code = 2;
    } catch (const files::UsageError& error) {
      message = error.what(), exit_code = 2;
    } catch (const files::InputError& error) {
      message = error.what(), exit_code = 3;
    }
    out = testing::internal::GetCapturedStdout();
    return exit_code;
  }
  std::string at(const std::string& name) const { return (folder / name).string(); }
  std::string text(const std::string& name) const { return files::read_whole(folder / name, 1 << 24); }
  const fs::path folder = fs::path(testing::TempDir()) / ("likeness_film_" + std::to_string(::getpid()));
  std::string out, message;
};

TEST_F(FilmCommand, WritesAPageAndAMaterialThatReadsBack) {
  ASSERT_EQ(run("--talk --out " + at("film")), 0) << message;
  EXPECT_THAT(out, testing::HasSubstr("10 subjects, light at 20 deg"));
  EXPECT_THAT(text("film/film.html"), testing::HasSubstr("A film of 5"));
  const material::Material tears = material::read_material(folder / "film/tears.material.json");
  const auto& ggx = std::get<brdf::Ggx<double>>(tears.brdf);
  EXPECT_GT(ggx.f0.b, ggx.f0.r) << "a film thinner than a quarter wave of blue is bluish";
  EXPECT_NEAR(ggx.f0.g, 0.0454, 0.0005);  // of 54 nm
  const json::Value told = json::parse(text("film/film.json"), "film.json");
  EXPECT_NEAR(told.find("head_on")->find("specular")->number, 0.559, 0.005);
  EXPECT_EQ(told.find("subjects")->items.size(), 10u);
  EXPECT_EQ(told.find("chosen")->text, "scaled");
}

TEST_F(FilmCommand, TakesPairsFilesAndAScaleOfOne) {
  files::write_whole(folder / "a.csv", "subject,500,700\na,0.0406,0.0316\n");
  ASSERT_EQ(run(at("a.csv") + " --json"), 0) << message;
  const std::string from_file = out;
  ASSERT_EQ(run("--reflectance 500:0.0406 --reflectance 700:0.0316 --json"), 0) << message;
  const auto best = [](const std::string& told, std::string_view which) {
    return json::parse(told, "out").find(which)->find("candidates")->items[0].find("thickness_nm")->number;
  };
  EXPECT_EQ(best(from_file, "scaled"), best(out, "scaled"));
  EXPECT_NEAR(best(from_file, "absolute"), 43, 1);  // both readings agree on it
  ASSERT_EQ(run(at("a.csv") + " --scale 1 --json"), 0);
  EXPECT_NEAR(json::parse(out, "out").find("head_on")->find("luminance")->number, 0.037, 0.002);
}

TEST_F(FilmCommand, RefusesWhatItCannotUse) {
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("--talk --reflectance 500:0.04"), 2);
  EXPECT_EQ(run("--reflectance 500:4 --reflectance 700:3"), 2);
  EXPECT_EQ(run("--talk --scale 2"), 2);
  EXPECT_EQ(run(at("absent.csv")), 3);
  files::write_whole(folder / "bad.csv", "subject,500,700\na,0.04,-1\n");
  EXPECT_EQ(run(at("bad.csv") + " --out " + at("folder")), 3);
  EXPECT_THAT(message, testing::HasSubstr("bad.csv:2:"));
  EXPECT_FALSE(fs::exists(folder / "folder"));
}

}  // namespace
}  // namespace likeness::film
