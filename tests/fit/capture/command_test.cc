#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/capture/files_of_capture.h"
#include "render/capture/pixels.h"
#include "render/image/read.h"
#include "render/material/material_file.h"
#include "tests/fit/capture/sphere_capture.h"
#include "tests/render/temporary_folder.h"

namespace likeness::capture_fit {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

struct Said {
  int exit_code = -1;
  std::string out, err;
};
std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
Said run(const TemporaryFolder& folder, const std::string& arguments) {
  const std::string command = "cd '" + folder.path().string() + "' && timeout 60 '" LIKENESS_PROGRAM "' " + arguments +
                              " </dev/null >out.txt 2>err.txt";
  const int status = std::system(command.c_str());  // NOLINT(bugprone-command-processor,cert-env33-c): our own words
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(folder / "out.txt"), content(folder / "err.txt")};
}

void write_sphere(const TemporaryFolder& folder, const std::string& name) {
  test::SphereCapture want{.size = 24, .lights = test::spiral_of_lights(20)};
  capture::Capture capture = make_sphere(folder / name, want);
  for (capture::Frame& frame : capture.frames) frame.clip = 1e6;
  write_capture(capture);
}

TEST(Command, WritesMapsMaterialPageAndNumbersThatOtherCommandsRead) {
  const TemporaryFolder folder;
  write_sphere(folder, "c");
  const Said fit = run(folder, "fit capture c --register");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_THAT(fit.out, HasSubstr("report.html"));
  const auto made = folder / "c" / "aux" / "c" / "fit";
  for (const char* name :
       {"normal.exr", "base_color.exr", "confidence.exr", "material.json", "fit.json", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(made / name)) << name;
  EXPECT_NO_THROW(material::read_material(made / "material.json"));
  EXPECT_THAT(content(made / "report.html"), HasSubstr("The material that all pixels share"));
  EXPECT_THAT(content(made / "report.html"), Not(HasSubstr("nan")));
  EXPECT_THAT(content(made / "fit.json"), HasSubstr("\"likeness capture fit\""));

  const capture::Capture capture = capture::read_capture(folder / "c");
  const image::Picture normals = capture::read_normals(capture, 0);
  EXPECT_GT(normals.at(12, 12)[2], 0.9f);
  EXPECT_FALSE(layer_file(capture, 0, capture::Layer::kAlbedo).empty());
  EXPECT_TRUE(capture.layers[0].file.is_relative());

  const Said render =
      run(folder, "olat render c --from-normals --material c/aux/c/fit/material.json --light l1 --variant v");
  ASSERT_EQ(render.exit_code, 0) << render.err;
  const image::Picture made_render =
      capture::read_render(capture, {"v", "renders/{variant}/{camera}/{light}.exr"}, 0, 1);
  const image::Picture photo = capture::read_photo(capture, 1).light;
  EXPECT_NEAR(made_render.at(12, 12)[1], photo.at(12, 12)[1], 0.05f * photo.at(12, 12)[1]);
}

TEST(Command, WithoutRegisterTheCaptureIsNotChanged) {
  const TemporaryFolder folder;
  write_sphere(folder, "c");
  const std::string before = content(folder / "c" / "cameras.json");
  const Said fit = run(folder, "fit capture c --out made --json");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_EQ(before, content(folder / "c" / "cameras.json"));
  EXPECT_EQ(fit.out, content(folder / "made" / "fit.json").substr(0, fit.out.size()));
  EXPECT_FALSE(std::filesystem::exists(folder / "c" / "aux"));
}

TEST(Command, RefusesInOneLineThatNamesTheWayOut) {
  const TemporaryFolder folder;
  write_sphere(folder, "c");
  const auto expect = [&](const std::string& arguments, int exit_code, const std::string& words) {
    const Said said = run(folder, arguments);
    EXPECT_EQ(said.exit_code, exit_code) << arguments << "\n" << said.err;
    EXPECT_THAT(said.err, HasSubstr(words)) << arguments;
    EXPECT_EQ(std::count(said.err.begin(), said.err.end(), '\n'), 1) << said.err;
  };
  expect("fit capture nowhere", 3, "nowhere");
  expect("fit capture c --camera d", 2, "--camera");
  expect("fit capture c --normals guessed", 2, "given, estimate");
  expect("fit capture c --normals given", 2, "--normals estimate");
  expect("fit capture c --seed -1", 2, "--seed");
  expect("fit capture c --memory-mb 0", 2, "--memory-mb");
  expect("fit", 2, "FILE");
  expect("fit paint.mbsdf capture c", 2, "two commands");
}

}  // namespace
}  // namespace likeness::capture_fit
