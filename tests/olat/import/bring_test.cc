#include "olat/import/bring.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "olat/import/export_lp.h"
#include "olat/import/light_lists.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "tests/olat/import/small_colmap.h"
#include "tests/render/picture_files.h"
#include "tests/render/temporary_folder.h"

namespace likeness::olat_import {
namespace {

namespace fs = std::filesystem;
using files::InputError;
using files::UsageError;
using likeness::test::TemporaryFolder;
using testing::HasSubstr;

// Photographs 1.png and 2.png of 2 x 1 pixels with a list of lights, a mask and normals.
struct Shoot {
  TemporaryFolder folder;
  fs::path photos = folder / "photos";
  explicit Shoot(const std::string& remark = "# linear\n") {
    put("1.png");
    put("2.png");
    put("cat_mask.png");
    put("normal_gt.png");
    files::write_whole(photos / "lights.csv",
                       remark + "file,lx,ly,lz,ir,ig,ib\n1.png,0,0.6,0.8,1,1,2\n2.png,1,0,0,1,1,1\n");
  }
  void put(const std::string& name) const {
    files::write_whole(photos / name, image::test::png_file(2, 1, 8, 2, {1, 2, 3, 40, 50, 60}));
  }
  ImportOptions options() const {
    ImportOptions out;
    out.path = photos.string();
    out.out = (folder / "capture").string();
    return out;
  }
};

std::string usage(const ImportOptions& options) {
  try {
    bring(options);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Import, ALightsCsvBecomesACaptureBesideItsPhotographs) {
  const Shoot shoot;
  const Import done = bring(shoot.options());
  EXPECT_TRUE(done.missing.empty());
  const capture::Capture got = capture::read_capture(shoot.folder / "capture");
  ASSERT_EQ(got.frames.size(), 2u);
  EXPECT_EQ(got.frames[0].file, fs::weakly_canonical(shoot.photos / "1.png"));
  EXPECT_EQ(got.frames[0].transfer, capture::Transfer::kLinear);
  EXPECT_EQ(got.lights[1].id, "2");
  EXPECT_EQ(got.cameras[0].width, 2);
  EXPECT_TRUE(got.cameras[0].is_orthographic);
  EXPECT_EQ(got.cameras[0].world_from_camera[1][1], -1);  // y up in the world, down in the picture
  EXPECT_EQ(layer_file(got, 0, capture::Layer::kMask).filename(), "cat_mask.png");
  EXPECT_EQ(layer_file(got, 0, capture::Layer::kNormal).filename(), "normal_gt.png");
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(shoot.folder / "capture")) count += entry.is_regular_file();
  EXPECT_EQ(count, 4u);  // the four files and no picture
  EXPECT_NEAR(capture::read_photo(got, 0).light.rgb[5], 60 / 255.0 / 2, 1e-6);
}

TEST(Import, AColorSpaceThatNothingStatesIsAskedFor) {
  const Shoot shoot("# pictures\n");
  ImportOptions options = shoot.options();
  EXPECT_THAT(usage(options), HasSubstr("1.png: its format does not say what its numbers mean; add --color-space"));
  EXPECT_FALSE(fs::exists(shoot.folder / "capture"));
  options.color_space = "srgb";
  EXPECT_EQ(bring(options).capture.frames[0].transfer, capture::Transfer::kSrgb);
  options.overwrites = true;
  options.color_space = "srgbb";
  EXPECT_THAT(usage(options), HasSubstr("did you mean srgb?"));
}

TEST(Import, ACaptureThatIsThereIsNotOverwrittenUnasked) {
  const Shoot shoot;
  ImportOptions options = shoot.options();
  bring(options);
  EXPECT_THAT(usage(options), HasSubstr("is there already; --overwrite"));
  options.overwrites = true;
  EXPECT_EQ(bring(options).capture.frames.size(), 2u);
}

TEST(Import, PhotographsThatAreNotThereAreCountedAndNamed) {
  const Shoot shoot;
  fs::remove(shoot.photos / "1.png");
  const Import done = bring(shoot.options());
  EXPECT_THAT(done.missing, testing::ElementsAre("1.png"));
  EXPECT_EQ(done.capture.lights.size(), 2u);
  ASSERT_EQ(done.capture.frames.size(), 1u);
  EXPECT_EQ(done.capture.frames[0].light, 1u);
  fs::remove(shoot.photos / "2.png");
  ImportOptions options = shoot.options();
  options.overwrites = true;
  EXPECT_THROW(bring(options), InputError);
}

TEST(Import, CopiesAreTheBytesAndHashesTheirs) {
  const Shoot shoot;
  ImportOptions options = shoot.options();
  options.copies = options.hashes = true;
  const capture::Capture got = bring(options).capture;
  EXPECT_EQ(got.frames[1].file, "photos/camera/2.png");
  const std::string bytes = files::read_whole(shoot.photos / "2.png", 1 << 20);
  EXPECT_EQ(files::read_whole(photo_file(got, got.frames[1]), 1 << 20), bytes);
  EXPECT_EQ(got.frames[1].sha256, files::sha256(bytes));
  EXPECT_EQ(layer_file(got, 0, capture::Layer::kMask), fs::path(options.out) / "aux/camera/mask.png");
}

TEST(Import, ADomeTakesTheFoldersPhotographsInTheOrderOfTheirNumbers) {
  const TemporaryFolder folder;
  for (const char* name : {"p10.png", "p9.png", "p_mask.png"})
    files::write_whole(folder / name, image::test::png_file(1, 1, 8, 0, {9}));
  files::write_whole(folder / "a.dome", R"({"directions": [[0, 0, 1], [1, 0, 0]]})");
  ImportOptions options;
  options.path = folder.path().string();
  options.out = (folder / "c").string();
  options.color_space = "linear";
  const capture::Capture got = bring(options).capture;
  EXPECT_EQ(got.lights[0].id, "p9");
  EXPECT_EQ(got.lights[1].id, "p10");
  fs::remove(folder / "p9.png");
  options.overwrites = true;
  EXPECT_THROW(bring(options), InputError);
}

TEST(Import, CamerasOfColmapTakePhotographsByAPattern) {
  const Shoot shoot;
  files::write_whole(shoot.photos / "sparse/0/cameras.txt", test::small_cameras());
  files::write_whole(shoot.photos / "sparse/0/images.txt", test::small_images());
  shoot.put("b_2.png");
  ImportOptions options = shoot.options();
  EXPECT_THAT(usage(options), HasSubstr("need --photos"));
  options.photos = "{camera}_{light}.png";
  const Import done = bring(options);
  ASSERT_EQ(done.capture.cameras.size(), 2u);
  EXPECT_EQ(done.capture.cameras[1].id, "b");
  ASSERT_EQ(done.capture.frames.size(), 1u);
  EXPECT_EQ(done.capture.frames[0].camera, 1u);
  EXPECT_EQ(done.missing.size(), 3u);
}

TEST(Export, AnLpHasTheCamerasAxesAndComesBackTheSame) {
  const Shoot shoot;
  const capture::Capture capture = bring(shoot.options()).capture;
  const Exported done = export_lp(capture, 0, shoot.folder / "out.lp");
  EXPECT_EQ(done.lights, 2u);
  const LightList got = read_lp(files::read_whole(shoot.folder / "out.lp", 1 << 20), "out.lp");
  EXPECT_EQ(got.lights[0].file, "photos/1.png");
  const glm::dvec3 to_light = std::get<capture::DistantLight>(got.lights[0].light.place).to_light;
  EXPECT_NEAR(to_light.y, 0.6, 1e-12);
  EXPECT_NEAR(to_light.z, 0.8, 1e-12);
}

TEST(SharedData, TheCatAndTheBuddhaAreImported) {
  const fs::path captures = LIKENESS_SHARED_DIR "/data/captures";
  if (!fs::exists(captures)) GTEST_SKIP() << captures << " is absent";
  const TemporaryFolder folder;
  ImportOptions options;
  options.path = (captures / "diligent-cat").string();
  options.out = (folder / "cat").string();
  const capture::Capture cat = bring(options).capture;
  EXPECT_EQ(cat.frames.size(), 96u);
  EXPECT_EQ(cat.layers.size(), 2u);
  EXPECT_EQ(cat.frames[0].transfer, capture::Transfer::kLinear);  // its list says so
  options.path = (captures / "uw-buddha").string();
  options.out = (folder / "buddha").string();
  EXPECT_THAT(usage(options), HasSubstr("--color-space"));
  options.color_space = "srgb";
  EXPECT_EQ(bring(options).capture.frames.size(), 12u);
}

}  // namespace
}  // namespace likeness::olat_import
