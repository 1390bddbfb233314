#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "render/texture/texture.h"

namespace likeness::texture {
namespace {

// 0 1 2 3 in a row, the next row 10 more.
scene::Image ramp(int width = 4, int height = 2) {
  scene::Image image{"", {width, height, 1, {}, {}}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.texels.floats.push_back(static_cast<float>(x + 10 * y));
  return image;
}

TEST(Texture, IsItsTexelsAtTheirCentersAndBilinearBetween) {
  const auto image = ramp();
  const scene::Texture t{0};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_FLOAT_EQ(number_at(image, t, {(static_cast<float>(x) + 0.5f) / 4, (static_cast<float>(y) + 0.5f) / 2}),
                      static_cast<float>(x + 10 * y));
  EXPECT_FLOAT_EQ(number_at(image, t, {0.5f, 0.25f}), 1.5f);
  EXPECT_FLOAT_EQ(number_at(image, t, {0.5f, 0.5f}), 6.5f);
  EXPECT_FLOAT_EQ(number_at(image, t, {0.25f + 0.25f / 4, 0.25f}), 0.75f);
  EXPECT_EQ(color_at(image, t, {0.125f, 0.75f}), glm::vec3(10));  // a grey one three times
}

TEST(Texture, RepeatsOrEndsAtItsEdges) {
  const auto image = ramp();
  scene::Texture t{0};
  EXPECT_FLOAT_EQ(number_at(image, t, {0, 0.25f}), 1.5f);  // halfway between the last and the first
  EXPECT_FLOAT_EQ(number_at(image, t, {1, 0.25f}), 1.5f);
  EXPECT_FLOAT_EQ(number_at(image, t, {-0.625f, 1.25f}), 1);
  EXPECT_FLOAT_EQ(number_at(image, t, {7.375f, -2.25f}), 11);
  EXPECT_FLOAT_EQ(number_at(image, t, {0.125f, 0}), 5);  // of rows too
  t.wrap = scene::Wrap::kClamp;
  EXPECT_FLOAT_EQ(number_at(image, t, {0, 0.25f}), 0);
  EXPECT_FLOAT_EQ(number_at(image, t, {1, 0.25f}), 3);
  EXPECT_FLOAT_EQ(number_at(image, t, {-9, -9}), 0);
  EXPECT_FLOAT_EQ(number_at(image, t, {9, 9}), 13);
}

TEST(Texture, ScalesPlacesAndValues) {
  const auto image = ramp();
  scene::Texture t{0};
  t.uv_scale = {2, 1}, t.uv_offset = {0.125f, 0.25f};
  EXPECT_FLOAT_EQ(number_at(image, t, {0.125f, 0}), 1);  // at 0.375
  t.scale = {2, 3, 4}, t.offset = {1, 0, -1};
  EXPECT_FLOAT_EQ(number_at(image, t, {0.125f, 0}), 3);
  EXPECT_EQ(color_at(image, t, {0.125f, 0}), glm::vec3(3, 3, 3));
}

TEST(Texture, IsFiniteForEveryPlace) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const int width : {1, 4})
    for (const auto wrap : {scene::Wrap::kRepeat, scene::Wrap::kClamp}) {
      const auto image = ramp(width, 1);
      scene::Texture t{0};
      t.wrap = wrap;
      for (const float u :
           {nan, infinity, -infinity, 1e30f, -1e30f, 1e7f, -1e-9f, -1e-30f, 0x1.fffffep-1f, 1.0f, -0.0f, 2147483648.0f})
        for (const float v : {nan, 1e30f, -1e-9f, 0.5f}) {
          const float x = number_at(image, t, {u, v});
          ASSERT_TRUE(x >= 0 && x <= 3) << u << " " << v << ": " << x;
        }
      EXPECT_EQ(number_at(image, t, {nan, nan}), number_at(image, t, {0, 0}));
    }
}

TEST(Texture, DecodesBytesAndLeavesAlphaAndFloatsAsTheyAre) {
  const scene::Image rgba{"", {1, 1, 4, {188, 0, 255, 188}, {}}};
  scene::Texture t{0, scene::Transfer::kSrgb};
  EXPECT_NEAR(color_at(rgba, t, {0, 0}).r, 0.5029, 1e-4);  // IEC 61966-2-1
  EXPECT_FLOAT_EQ(color_at(rgba, t, {0, 0}).b, 1);
  t.channel = 3;
  EXPECT_FLOAT_EQ(number_at(rgba, t, {0, 0}), 188.0f / 255);
  t.channel = 0;
  EXPECT_NEAR(number_at(rgba, t, {0, 0}), 0.5029, 1e-4);
  t.transfer = scene::Transfer::kLinear;
  EXPECT_FLOAT_EQ(number_at(rgba, t, {0, 0}), 188.0f / 255);
  t.channel = 2;
  EXPECT_FLOAT_EQ(number_at(rgba, t, {0, 0}), 1);
  const scene::Image floats{"", {1, 1, 3, {}, {0.25f, 0.5f, 4}}};
  t.transfer = scene::Transfer::kSrgb;
  EXPECT_EQ(color_at(floats, t, {0, 0}), glm::vec3(0.25f, 0.5f, 4));
  const scene::Image rgb{"", {1, 1, 3, {0, 0, 188}, {}}};
  t.channel = 2;
  EXPECT_NEAR(number_at(rgb, t, {0, 0}), 0.5029, 1e-4);  // the last of three is no alpha
  const scene::Image grey_alpha{"", {1, 1, 2, {188, 51}, {}}};
  t.channel = 1;
  EXPECT_FLOAT_EQ(number_at(grey_alpha, t, {0, 0}), 0.2f);
  EXPECT_NEAR(color_at(grey_alpha, t, {0, 0}).g, 0.5029, 1e-4);
}

}  // namespace
}  // namespace likeness::texture
