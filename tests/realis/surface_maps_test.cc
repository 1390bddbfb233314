#include "realis/surface_maps.h"

#include <gtest/gtest.h>

#include "tests/render/temporary_folder.h"

namespace likeness::realis {
namespace {

TEST(SurfaceMaps, ComeBackAsTheBakeSawThem) {
  const likeness::test::TemporaryFolder folder;
  capture_fit::Fit fit;
  fit.normals = image::Picture(3, 2), fit.base_colors = image::Picture(3, 2);
  fit.normals.rgb = {0, 0, 1, 0.6f, 0, 0.8f, -0.6f, 0.8f, 0, 0, 0, 0, 1, 0, 0, 0.57735f, -0.57735f, 0.57735f};
  for (std::size_t i = 0; i < 18; ++i) fit.base_colors.rgb[i] = 0.05f * static_cast<float>(i);
  fit.material.roughness = 0.3, fit.exposure = 1.7;
  const capture_fit::Fit seen = thin(fit);
  write_surface(folder.path(), fit);
  const capture_fit::Fit back = read_surface(folder.path(), 0);
  EXPECT_EQ(back.normals.rgb, seen.normals.rgb);
  EXPECT_EQ(back.base_colors.rgb, seen.base_colors.rgb);
  EXPECT_EQ(back.exposure, 1.7);
  EXPECT_EQ(back.material.roughness, 0.3);
  for (std::size_t i = 0; i < 18; ++i) {
    EXPECT_NEAR(seen.normals.rgb[i], fit.normals.rgb[i], 0.006) << "half a step of 1/127, and its part of the length";
    EXPECT_NEAR(seen.base_colors.rgb[i], fit.base_colors.rgb[i], 0.004);
  }
  EXPECT_EQ(seen.normals.rgb[9], 0) << "no normal stays none";
  EXPECT_EQ(thin(seen).normals.rgb, seen.normals.rgb) << "thin twice is thin once";
}

}  // namespace
}  // namespace likeness::realis
