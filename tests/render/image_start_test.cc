#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "render/image/picture.h"
#include "render/image/read.h"
#include "render/image/write.h"
#include "tests/render/temporary_folder.h"

namespace likeness::image {
namespace {

bool is_loaded(const std::string& library) {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (line.find(library) != line.npos) return true;
  return false;
}

// A process of its own, so that no other test has loaded it before.
TEST(ImageStart, LoadsOpenImageIoWithTheFirstPictureThatNeedsIt) {
  const likeness::test::TemporaryFolder folder;
  const Picture picture(3, 2);
  write_exr(folder / "a.exr", picture);
  EXPECT_EQ(read_picture(folder / "a.exr").rgb, picture.rgb);
  write_png(folder / "a.png", DisplayPicture(3, 2));
  EXPECT_FALSE(is_loaded("libOpenImageIO"));
  EXPECT_EQ(read_texels(folder / "a.png").width, 3);
  EXPECT_TRUE(is_loaded("libOpenImageIO"));
}

}  // namespace
}  // namespace likeness::image
