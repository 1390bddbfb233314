#include "render/baked/surface_maps.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/render/temporary_folder.h"

namespace likeness::baked {
namespace {

// A normal that is made unit may round to other bytes: what a bake was made against must be what is read.
TEST(SurfaceMaps, ThinSurfacesAreReadAsTheyAre) {
  const likeness::test::TemporaryFolder folder;
  Surface surface;
  surface.normals = image::Picture(200, 100), surface.base_colors = image::Picture(200, 100);
  std::mt19937 random(1);
  std::normal_distribution<float> value;
  for (std::size_t i = 0; i < surface.normals.rgb.size(); i += 3) {
    const float x = value(random), y = value(random), z = value(random), length = std::sqrt(x * x + y * y + z * z);
    surface.normals.rgb[i] = x / length, surface.normals.rgb[i + 1] = y / length,
    surface.normals.rgb[i + 2] = z / length;
    surface.base_colors.rgb[i] = std::abs(x), surface.base_colors.rgb[i + 1] = std::abs(y);
  }
  const Surface seen = thin(surface);
  write_surface(folder.path(), seen);
  const Surface back = read_surface(folder.path());
  EXPECT_EQ(back.normals.rgb, seen.normals.rgb);
  EXPECT_EQ(back.base_colors.rgb, seen.base_colors.rgb);
}

}  // namespace
}  // namespace likeness::baked
