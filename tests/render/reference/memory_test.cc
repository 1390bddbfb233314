#include <gtest/gtest.h>

#include "render/image/plane.h"
#include "render/reference/film.h"
#include "tests/render/resident.h"

// What a film takes, so that a picture of 3840 x 2160 stays far below 4 GB (docs/renderer.md).
namespace likeness::reference {
namespace {

using test::resident_bytes;

constexpr int kWidth = 2048, kHeight = 1024;
constexpr double kPixels = double(kWidth) * kHeight;
constexpr double kLargePages = 5 * 2097152.0;  // each buffer begins and ends at one of 2 MB

TEST(Memory, AFilmThatNobodyHasWorkedOnTakesNone) {
  if (!test::kCountsMemory) GTEST_SKIP() << "a sanitizer holds memory of its own";
  const double before = resident_bytes();
  const Film film(kWidth, kHeight, true);
  EXPECT_LT(resident_bytes() - before, 1e6);
}

TEST(Memory, AFilmTakes56BytesAPixelAnd172WithLayers) {
  if (!test::kCountsMemory) GTEST_SKIP() << "a sanitizer holds memory of its own";
  for (const bool has_layers : {false, true}) {
    const double before = resident_bytes(), expected = has_layers ? 172 : 56;
    Film film(kWidth, kHeight, has_layers);
    First first;
    first.base_color = glm::vec3(0.5f);
    for (std::size_t pixel = 0; pixel < std::size_t{kWidth} * kHeight; ++pixel) film.add(pixel, glm::vec3(1), &first);
    const double growth = resident_bytes() - before;
    EXPECT_LE(growth, expected * kPixels + kLargePages) << has_layers;
    EXPECT_GE(growth, 0.9 * expected * kPixels) << "it is not seen by this test" << has_layers;
  }
}

TEST(Plane, IsZeroSmallAndLargeAndAgainAfterItWasGivenBack) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1000}, std::size_t{700'000}})
    for (int repeat = 0; repeat < 3; ++repeat) {
      image::Plane<float> plane(count);
      ASSERT_EQ(plane.size(), count);
      for (float& x : plane) {
        ASSERT_EQ(x, 0.0f);
        x = 1;
      }
    }
}

TEST(Plane, RefusesWhatNoMemoryHolds) {
  image::UntouchedMemory<double> memory;
  EXPECT_THROW(static_cast<void>(memory.allocate(~std::size_t{0} / 16)), std::bad_alloc);
  EXPECT_THROW(static_cast<void>(memory.allocate(~std::size_t{0} / 4)), std::bad_alloc);
}

}  // namespace
}  // namespace likeness::reference
