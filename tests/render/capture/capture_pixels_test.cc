#include "render/capture/pixels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "render/files/files.h"
#include "render/image/write.h"
#include "tests/render/capture/small_capture.h"
#include "tests/render/picture_files.h"
#include "tests/render/temporary_folder.h"

namespace likeness::capture {
namespace {

using files::InputError;
using likeness::test::TemporaryFolder;
using testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// One camera of w x h pixels, one light, one frame of the file "photo.pfm" or another.
Capture capture_of_one(const std::filesystem::path& root, int width, int height, const std::string& file) {
  Capture out;
  out.root = root;
  Camera camera;
  camera.id = "c";
  camera.width = width;
  camera.height = height;
  out.cameras = {camera};
  out.lights = {{"l", "", DistantLight{}, {1, 1, 1}, ""}};
  out.frames = {{.camera = 0, .light = 0, .file = file}};
  return out;
}

void put(const std::filesystem::path& file, const std::string& bytes) { files::write_whole(file, bytes); }

std::vector<float> light_of_pixels(const Photo& photo) { return photo.light.rgb; }

TEST(CaptureCurves, EveryCurveIsUndoneByItsInverse) {
  for (const Transfer transfer : {Transfer::kLinear, Transfer::kSrgb, Transfer::kRec709, Transfer::kGamma22})
    for (float x = -1.5f; x <= 1.5f; x += 1 / 64.0f) {
      // The standard's own pieces of sRGB meet to 4e-8.
      EXPECT_NEAR(linear_of(transfer, encoded_of(transfer, x)), x, 1e-6f) << int(transfer) << ' ' << x;
      EXPECT_EQ(linear_of(transfer, -x), -linear_of(transfer, x));
    }
}

TEST(CaptureCurves, CurvesAreThoseOfTheirStandards) {
  EXPECT_NEAR(encoded_of(Transfer::kSrgb, 0.18f), 0.461356f, 1e-6f);
  EXPECT_NEAR(encoded_of(Transfer::kRec709, 0.18f), 0.408848f, 1e-5f);  // 1.0993 x^0.45 - 0.0993
  EXPECT_NEAR(encoded_of(Transfer::kRec709, 0.01f), 0.045f, 1e-7f);
  EXPECT_NEAR(encoded_of(Transfer::kGamma22, 0.5f), 0.729740f, 1e-6f);
}

TEST(Photo, BlackWhiteCurveGainAndIntensityActInThisOrder) {
  const TemporaryFolder folder;
  Capture capture = capture_of_one(folder.path(), 2, 1, "p.pfm");
  put(folder / "p.pfm", image::test::pfm_file(2, 1, 3, {0.5f, 0.3f, 0.1f, 0.7f, 0.0f, 0.2f}));
  Frame& frame = capture.frames[0];
  frame.black = 0.1;
  frame.white = 0.6;
  frame.transfer = Transfer::kGamma22;
  frame.gain = 3;
  capture.lights[0].intensity = {1, 2, 4};
  const Photo photo = read_photo(capture, 0);
  const auto want = [&](double x, double intensity) {
    const double y = (x - 0.1) / 0.5;
    return std::copysign(std::pow(std::abs(y), 2.2), y) * 3 / intensity;
  };
  EXPECT_NEAR(photo.light.rgb[0], want(0.5, 1), 1e-6);
  EXPECT_NEAR(photo.light.rgb[1], want(0.3, 2), 1e-6);
  EXPECT_NEAR(photo.light.rgb[2], 0, 1e-6);
  EXPECT_NEAR(photo.light.rgb[3], want(0.7, 1), 2e-6);
  EXPECT_NEAR(photo.light.rgb[4], want(0.0, 2), 1e-6);  // below black: negative light is kept
  EXPECT_LT(photo.light.rgb[4], 0);
  EXPECT_EQ(photo.flaws[0], 0);
  EXPECT_EQ(photo.flaws[1], kClipped);  // 0.7 is 1.2 after black and white
}

TEST(Photo, AFrameOfAllLightsIsNotDividedByOneOfThem) {
  const TemporaryFolder folder;
  Capture capture = capture_of_one(folder.path(), 1, 1, "p.pfm");
  put(folder / "p.pfm", image::test::pfm_file(1, 1, 3, {0.5f, 0.25f, 0.125f}));
  capture.lights[0].intensity = {2, 2, 2};
  capture.frames[0].kind = FrameKind::kFull;
  EXPECT_EQ(light_of_pixels(read_photo(capture, 0)), (std::vector<float>{0.5f, 0.25f, 0.125f}));
}

TEST(Photo, FlawsSayWhyAPixelIsNotTrusted) {
  const TemporaryFolder folder;
  Capture capture = capture_of_one(folder.path(), 5, 1, "p.pfm");
  const float inf = std::numeric_limits<float>::infinity();
  put(folder / "p.pfm", image::test::pfm_file(5, 1, 3, {0, -1, 0, 0, 0, 1e-6f, 1, 0, 0, kNan, 1, 1, 0.5f, inf, 0.5f}));
  put(folder / "mask.png", image::test::png_file(5, 1, 8, 0, {255, 127, 128, 255, 0}));
  capture.layers = {{0, Layer::kMask, "mask.png"}};
  const Photo photo = read_photo(capture, 0);
  EXPECT_EQ(photo.flaws[0], kBlack);
  EXPECT_EQ(photo.flaws[1], kMasked);
  EXPECT_EQ(photo.flaws[2], kClipped);
  EXPECT_EQ(photo.flaws[3], kNotFinite | kClipped);
  EXPECT_EQ(photo.flaws[4], kNotFinite | kMasked | kClipped);
  for (std::size_t i = 9; i < 15; ++i) EXPECT_EQ(photo.light.rgb[i], 0) << i;
  capture.frames[0].clip = inf;
  EXPECT_EQ(read_photo(capture, 0).flaws[2], 0);
}

TEST(Photo, BytesGreyAndSixteenBitsAreTheSameNumbers) {
  const TemporaryFolder folder;
  Capture capture = capture_of_one(folder.path(), 1, 1, "p.png");
  capture.frames[0].transfer = Transfer::kSrgb;
  put(folder / "p.png", image::test::png_file(1, 1, 8, 2, {51, 102, 255}));
  const Photo bytes = read_photo(capture, 0);
  put(folder / "p.png", image::test::png_file(1, 1, 16, 2, {13107, 26214, 65535}));  // the same fifths
  const Photo words = read_photo(capture, 0);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(bytes.light.rgb[c], words.light.rgb[c], 1e-6f) << c;
  EXPECT_NEAR(bytes.light.rgb[0], 0.033105f, 1e-6f);  // sRGB of 0.2
  EXPECT_EQ(bytes.flaws[0], kClipped);
  put(folder / "p.png", image::test::png_file(1, 1, 8, 0, {102}));
  EXPECT_THAT(read_photo(capture, 0).light.rgb, testing::Each(bytes.light.rgb[1]));
}

TEST(Photo, ColorsBecomeRec709) {
  const TemporaryFolder folder;
  Capture capture = capture_of_one(folder.path(), 1, 1, "p.pfm");
  put(folder / "p.pfm", image::test::pfm_file(1, 1, 3, {0.5f, 0.5f, 0.5f}));
  capture.frames[0].primaries = Primaries::kAcesCg;
  EXPECT_THAT(read_photo(capture, 0).light.rgb, testing::Each(testing::FloatNear(0.5f, 1e-6f)));  // white stays white
  put(folder / "p.pfm", image::test::pfm_file(1, 1, 3, {1, 0, 0}));
  EXPECT_NEAR(read_photo(capture, 0).light.rgb[0], 1.705051f, 1e-5f);
  EXPECT_NEAR(read_photo(capture, 0).light.rgb[1], -0.130256f, 1e-5f);
  capture.frames[0].primaries = Primaries::kCamera;
  capture.cameras[0].rec709_from_camera = glm::dmat3(2, 3, 4, 0, 1, 0, 0, 0, 1);  // first column
  EXPECT_EQ(light_of_pixels(read_photo(capture, 0)), (std::vector<float>{2, 3, 4}));
}

TEST(Photo, AFlatFieldDividesAndItsZerosAreFlawed) {
  const TemporaryFolder folder;
  Capture capture = capture_of_one(folder.path(), 2, 1, "p.pfm");
  put(folder / "p.pfm", image::test::pfm_file(2, 1, 3, {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f}));
  put(folder / "flat.pfm", image::test::pfm_file(2, 1, 3, {0.5f, 1, 2, 0, 1, 1}));
  capture.layers = {{0, Layer::kFlatField, "flat.pfm"}};
  const Photo photo = read_photo(capture, 0);
  EXPECT_EQ(photo.light.rgb[0], 1);
  EXPECT_EQ(photo.light.rgb[2], 0.25f);
  EXPECT_EQ(photo.flaws[1], kNotFinite);
}

TEST(Photo, AnotherSizeAndAbsentFilesAreNamed) {
  const TemporaryFolder folder;
  Capture capture = capture_of_one(folder.path(), 3, 2, "p.pfm");
  put(folder / "p.pfm", image::test::pfm_file(2, 3, 3, std::vector<float>(18)));
  try {
    read_photo(capture, 0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("p.pfm: has 2 x 3 pixels; its camera \"c\" has 3 x 2"));
  }
  capture.frames[0].file = "absent.exr";
  EXPECT_THROW(read_photo(capture, 0), InputError);
}

TEST(Render, IsReadAsItIs) {
  const TemporaryFolder folder;
  Capture capture = capture_of_one(folder.path(), 1, 1, "p.pfm");
  capture.variants = {{"v", "renders/{variant}/{camera}/{light}.exr"}};
  image::Picture picture(1, 1);
  picture.rgb = {4, -1, 0.5f};
  image::write_exr(folder / "renders/v/c/l.exr", picture);
  capture.lights[0].intensity = {9, 9, 9};
  EXPECT_EQ(read_render(capture, capture.variants[0], 0, 0).rgb, picture.rgb);
  capture.cameras[0].width = 2;
  EXPECT_THROW(read_render(capture, capture.variants[0], 0, 0), InputError);
}

TEST(Normals, AreUnitFromSignedAndFromStoredHalves) {
  const TemporaryFolder folder;
  Capture capture = capture_of_one(folder.path(), 3, 1, "p.pfm");
  put(folder / "n.pfm", image::test::pfm_file(3, 1, 3, {0, 0, 2, 0, 0, 0, kNan, 0, 1}));
  capture.layers = {{0, Layer::kNormal, "n.pfm"}};
  EXPECT_EQ(read_normals(capture, 0).rgb, (std::vector<float>{0, 0, 1, 0, 0, 0, 0, 0, 0}));
  put(folder / "n.png",
      image::test::png_file(3, 1, 16, 2, {32768, 32768, 65535, 65535, 32768, 32768, 32768, 32767, 32768}));
  capture.layers[0].file = "n.png";
  const image::Picture stored = read_normals(capture, 0);
  EXPECT_NEAR(stored.rgb[2], 1, 1e-4);
  EXPECT_NEAR(stored.rgb[3], 1, 1e-4);
  EXPECT_EQ(stored.rgb[8], 0);  // grey: no normal
  capture.layers.clear();
  EXPECT_THROW(read_normals(capture, 0), InputError);
}

TEST(SharedData, TheCatIsUprightAndItsNormalsLookAtTheCamera) {
  const std::filesystem::path cat = LIKENESS_SHARED_DIR "/data/captures/diligent-cat";
  if (!std::filesystem::exists(cat)) GTEST_SKIP() << cat << " is absent";
  Capture capture = capture_of_one(cat, 282, 307, "001.png");
  capture.layers = {{0, Layer::kMask, "mask.png"}, {0, Layer::kNormal, "normal_gt.pfm"}};
  const auto mask = read_mask(capture, 0);
  const image::Picture normals = read_normals(capture, 0);
  std::size_t inside = 0, agree = 0;
  double upper = 0, lower = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const bool has = normals.rgb[3 * i + 2] > 0;
    inside += mask[i];
    agree += has == (mask[i] != 0);
    (i < mask.size() / 3 ? upper : lower) += static_cast<double>(normals.rgb[3 * i + 1]);
  }
  EXPECT_GT(inside, 40000u);
  EXPECT_GT(double(agree), 0.999 * double(mask.size()));  // upside down they would overlap by 80 %
  EXPECT_GT(upper, 0);                                    // y is up: the top of the cat looks up
  EXPECT_LT(lower, 0);
  const Photo photo = read_photo(capture, 0);
  double sum = 0;
  for (const float x : photo.light.rgb) sum += static_cast<double>(x);
  EXPECT_GT(sum / double(photo.light.rgb.size()), 1e-3);
}

// The grey patches of a ColorChecker, whose reflectances are known, keep their ratios: no curve is left in the numbers.
TEST(SharedData, ARawPhotographIsLinear) {
  const std::filesystem::path chart = LIKENESS_SHARED_DIR "/data/colour/colorchart.dng";
  if (!std::filesystem::exists(chart)) GTEST_SKIP() << chart << " is absent";
  const image::Picture raw = read_encoded(chart);
  ASSERT_EQ(raw.width, 1734);
  ASSERT_EQ(raw.height, 1156);
  // Y of the six greys (white to black), and where their middles are.
  const double reference[6] = {0.9131, 0.5894, 0.3632, 0.1915, 0.0883, 0.0311};
  const int middle[6] = {704, 814, 922, 1030, 1144, 1254};
  double green[6] = {};
  for (int k = 0; k < 6; ++k)
    for (int y = -20; y < 20; ++y)
      for (int x = -20; x < 20; ++x) green[k] += static_cast<double>(raw.at(middle[k] + x, 924 + y)[1]) / 1600;
  // 3 % of flare lie on the black patch, so the slope is a little below 1; with the sRGB curve left in it is 0.45.
  const double slope = std::log(green[0] / green[5]) / std::log(reference[0] / reference[5]);
  EXPECT_NEAR(slope, 0.94, 0.03);
  EXPECT_NEAR(green[0] / green[2], reference[0] / reference[2], 0.05 * reference[0] / reference[2]);
}

}  // namespace
}  // namespace likeness::capture
