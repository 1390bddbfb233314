#include "fit/slice/slice.h"

#include <cmath>
#include <numbers>

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fit/slice/evaluator_slice.h"
#include "fit/slice/labels.h"
#include "render/image/tone_curve.h"
#include "render/material/material_file.h"
#include "tests/brdf/eval/program.h"

// Slices as pictures, and `likeness slice` as a user runs it.
namespace likeness::fit {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;

brdf::Callisto<double> cloth() {
  brdf::Callisto<double> model;
  model.base_color = {0.6, 0.2, 0.1};
  model.roughness = 0.35;
  model.diffuse_fresnel = 6;
  model.smooth_terminator = -0.5;
  return model;
}
std::vector<eval::Assignment> assignments_of_cloth() {
  return {
      {"base_color", {0.6, 0.2, 0.1}}, {"roughness", {0.35}}, {"diffuse_fresnel", {6}}, {"smooth_terminator", {-0.5}}};
}

TEST(SliceGrid, PixelsAreTheModelAtAnySizeAndAzimuth) {
  const auto model = cloth();
  for (const SliceGrid grid : {SliceGrid{}, SliceGrid{33, 0.3}, SliceGrid{200, std::numbers::pi}}) {
    const SlicePicture slice = slice_of(brdf::AnyBrdf(model), grid);
    ASSERT_EQ(slice.size(), grid.size);
    for (const auto& [column, row] : {std::pair{0, 0}, {grid.size - 1, 0}, {5, grid.size - 1}, {17, 20}}) {
      const double h = (column + 0.5) * 90 / grid.size * kDegree,
                   d = (grid.size - row - 0.5) * 90 / grid.size * kDegree;
      const auto want = model.eval(brdf::geometry_at(h, d, grid.phi_d));
      EXPECT_NEAR(slice.f.at(column, row)[0], want.r, 1e-6 * want.r) << column << ", " << row;  // float
      EXPECT_NEAR(slice.f.at(column, row)[2], want.b, 1e-6 * want.b) << column << ", " << row;  // float
    }
  }
}

TEST(SliceGrid, AnEvaluatorOfTheCatalogGivesTheSamePicture) {
  const SliceGrid grid{64, 1.1};
  const SlicePicture want = slice_of(brdf::AnyBrdf(cloth()), grid);
  const SlicePicture got = slice_of(*catalog::find("callisto"), assignments_of_cloth(), grid);
  EXPECT_EQ(got.valid, want.valid);
  for (std::size_t i = 0; i < want.f.rgb.size(); ++i)
    ASSERT_NEAR(got.f.rgb[i], want.f.rgb[i], 1e-6 * want.f.rgb[i]) << i;  // float; the same formulas in double
}

TEST(SliceGrid, EveryEvaluatorWithHalfAnglesCanBeDrawn) {
  int drawn = 0;
  for (const catalog::Entry& entry : catalog::entries()) {
    if (half_angle_form(entry) == nullptr) continue;
    const SlicePicture slice = slice_of(entry, {}, {16, 1.5});
    for (std::size_t i = 0; i < slice.f.rgb.size(); ++i) ASSERT_TRUE(std::isfinite(slice.f.rgb[i])) << entry.name;
    ++drawn;
  }
  EXPECT_GE(drawn, 5);
  EXPECT_THROW(slice_of(*catalog::find("ggx_d"), {}, {16, 1.5}), files::UsageError);
}

TEST(Labels, ALetterHasItsShapeAndColor) {
  image::DisplayPicture picture(20, 10);
  write_text(picture, 1, 1, "T", {.color = {255, 0, 0}});
  std::string shape;
  for (int y = 1; y <= 7; ++y)
    for (int x = 1; x <= 5; ++x) shape += picture.at(x, y)[0] == 255 ? '#' : '.';
  EXPECT_EQ(shape, "#####..#....#....#....#....#....#..");
  EXPECT_EQ(text_width("T", 1), 5);
  EXPECT_EQ(text_width("AB", 2), 22);
}

TEST(Labels, TextMayRunUpwardsAndOutOfThePicture) {
  image::DisplayPicture picture(10, 20);
  write_text(picture, 1, 18, "L", {.color = {255, 255, 255}, .upwards = true});
  EXPECT_EQ(picture.at(1, 18)[0], 255) << "the foot of the L's stem is its upper left corner, turned";
  EXPECT_EQ(picture.at(7, 14)[0], 255) << "its arm ends at the right, four pixels up";
  write_text(picture, -50, -50, "FAR AWAY", {.scale = 3, .outlined = true});
  write_text(picture, 8, 15, "OVER THE EDGE", {.scale = 2, .outlined = true});
}

TEST(Labels, AxesLeaveTheSliceAsItIs) {
  const SlicePicture slice = slice_of(brdf::AnyBrdf(cloth()), {300, 1.5});
  const image::DisplayPicture plain = slice_picture(slice, 1), framed = with_axes(plain, "a title");
  EXPECT_GT(framed.width, plain.width);
  EXPECT_GT(framed.height, plain.height);
  // The frame's upper edge is the first line of 302 dark pixels.
  int found_x = -1, found_y = -1;
  for (int y = 0; y < framed.height && found_x < 0; ++y)
    for (int x = 0, run = 0; x < framed.width && found_x < 0; ++x) {
      run = framed.at(x, y)[0] == 40 ? run + 1 : 0;
      if (run == 302) found_x = x - 300, found_y = y + 1;
    }
  ASSERT_GT(found_x, 0);
  int different = 0;
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 300; ++x) different += framed.at(found_x + x, found_y + y)[1] != plain.at(x, y)[1];
  EXPECT_GT(different, 100);
  EXPECT_LT(different, 9000);
}

// ---- the program

class SliceCommand : public eval::test::Program {
 protected:
  eval::test::Ran slice(const std::string& arguments) const { return shell("exec likeness slice " + arguments); }

  image::Picture exr(const std::string& name) const {
    Imf::InputFile in((folder / name).c_str());
    const Imath::Box2i window = in.header().dataWindow();
    image::Picture picture(window.max.x + 1, window.max.y + 1);
    Imf::FrameBuffer pixels;
    const char* const names[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c)
      pixels.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(picture.rgb.data() + c), 12,
                                         12 * std::size_t(picture.width)));
    in.setFrameBuffer(pixels);
    in.readPixels(0, window.max.y);
    return picture;
  }
};

TEST_F(SliceCommand, DrawsAModelAsLinearAndAsDisplayedPicture) {
  const auto ran = slice(
      "callisto --set roughness=0.35 --set base_color=0.6,0.2,0.1 --set diffuse_fresnel=6 "
      "--set smooth_terminator=-0.5 --size 40 --out cloth");
  EXPECT_EQ(ran.exit_code, 0) << ran.error;
  EXPECT_THAT(ran.out, HasSubstr("cloth.exr  f [1/sr], linear RGB, 40 x 40\n"));
  EXPECT_THAT(ran.out, HasSubstr("cloth.png  sRGB at "));
  EXPECT_EQ(exr("cloth.exr").rgb, slice_of(*catalog::find("callisto"), assignments_of_cloth(), {40}).f.rgb);
  EXPECT_EQ(read("cloth.png").substr(1, 3), "PNG");
}

TEST_F(SliceCommand, DrawsAMaterialFileEitherWay) {
  material::write_material(folder / "cloth.material.json", {"a cloth", cloth()});
  ASSERT_EQ(slice("cloth.material.json --size 16 --out a").exit_code, 0);
  ASSERT_EQ(slice("--material cloth.material.json --size 16 --out b.png").exit_code, 0);
  ASSERT_EQ(slice("callisto --material cloth.material.json --size 16 --out c.exr").exit_code, 0);
  const auto want = slice_of(*catalog::find("callisto"), assignments_of_cloth(), {16}).f.rgb;
  for (const char* name : {"a.exr", "b.exr", "c.exr"}) EXPECT_EQ(exr(name).rgb, want) << name;
  ASSERT_EQ(slice("cloth.material.json --set roughness=0.9 --size 16 --out d").exit_code, 0);
  EXPECT_NE(exr("d.exr").rgb, want);
}

TEST_F(SliceCommand, DrawsAMeasuredFileAndSaysWhereItHasNoData) {
  ASSERT_EQ(shell("likeness make material --set base_color=0.5 --format mbsdf --theta-bins 20 --phi-bins 20 "
                  "--invalid-above 60 --out made.mbsdf")
                .exit_code,
            0);
  const auto ran = slice("made.mbsdf --size 30 --ev 0 --out made");
  EXPECT_EQ(ran.exit_code, 0) << ran.error;
  EXPECT_THAT(ran.out, HasSubstr("made.png  sRGB at 0 EV\n"));
  EXPECT_THAT(ran.out, HasSubstr("no data in "));
  const image::Picture picture = exr("made.exr");
  EXPECT_EQ(picture.at(29, 0)[0], 0);
  EXPECT_GT(picture.at(5, 25)[0], 0.1);
}

TEST_F(SliceCommand, LabelsChangeThePngAlone) {
  ASSERT_EQ(slice("ggx --size 64 --out plain").exit_code, 0);
  ASSERT_EQ(slice("ggx --size 64 --labels --out labelled").exit_code, 0);
  EXPECT_EQ(read("plain.exr"), read("labelled.exr"));
  EXPECT_GT(read("labelled.png").size(), read("plain.png").size());
}

TEST_F(SliceCommand, RefusesWhatItCannotDraw) {
  material::write_material(folder / "cloth.material.json", {"", cloth()});
  write("poem.binary", "Tyger Tyger, burning bright\n");
  const auto refuses = [&](const std::string& arguments, int code, const std::vector<std::string>& words) {
    const auto ran = slice(arguments);
    EXPECT_EQ(ran.exit_code, code) << arguments << ran.error;
    EXPECT_EQ(std::count(ran.error.begin(), ran.error.end(), '\n'), 1) << ran.error;
    for (const std::string& word : words) EXPECT_THAT(ran.error, HasSubstr(word));
    EXPECT_FALSE(fs::exists(folder / "x.exr")) << arguments;
  };
  refuses("--out x", 2, {"nothing to draw"});
  refuses("ggx", 2, {"--out is missing"});
  refuses("gxg --out x", 2, {"no model \"gxg\"", "--list"});
  refuses("calisto --out x", 2, {"did you mean callisto?"});
  refuses("ggx_d --out x", 2, {"ggx_d has no slice", "theta_h"});
  refuses("ggx --size 4 --out x", 2, {"--size 4 is outside [8, 4096]"});
  refuses("ggx --phi-d 90 --out x", 2, {"--phi-d 90", "radians"});
  refuses("ggx --ev 100 --out x", 2, {"--ev 100"});
  refuses("ggx --set roughnes=1 --out x", 2, {"did you mean roughness?"});
  refuses("ggx --set theta_h=1 --out x", 2, {"theta_h"});
  refuses("ggx --material cloth.material.json --out x", 2, {"is of the model callisto, not of ggx"});
  refuses("cloth.material.json --material cloth.material.json --out x", 2, {"a second material file"});
  refuses("poem.binary --set roughness=1 --out x", 2, {"--set changes models"});
  refuses("absent.binary --out x", 3, {"absent.binary"});
  refuses("poem.binary --out x", 3, {"poem.binary"});
  refuses("absent.material.json --out x", 3, {"absent.material.json"});
}

}  // namespace
}  // namespace likeness::fit
