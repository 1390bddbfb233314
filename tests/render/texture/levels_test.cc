#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "brdf/normal_length.h"
#include "render/texture/levels.h"
#include "render/texture/texture.h"

namespace likeness::texture {
namespace {

constexpr Filter kFilters[]{Filter::kFull, Filter::kNearest, Filter::kTrilinear, Filter::kAnisotropic};
const float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

template <class F>
scene::Image grey(int width, int height, F&& value) {
  scene::Image image{"", {width, height, 1, {}, {}}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.texels.floats.push_back(value(x, y));
  return image;
}
float checker(int x, int y) { return (x + y) % 2 == 0 ? 1.0f : 0.0f; }

// A pixel that covers so many texels of a square picture.
Footprint square(float texels, int side) {
  const float w = texels / static_cast<float>(side);
  return {{w, 0}, {0, w}};
}

TEST(Probes, AreOneAtFullSizeWhereAPixelCoversATexelOrLess) {
  for (const Filter filter : kFilters)
    for (const float texels : {0.0f, 1e-30f, 0.3f, 1.0f}) {
      const Probes p = probes_of(square(texels, 64), {}, {0.3f, 0.4f}, 64, 64, 7, filter);
      EXPECT_TRUE(p.is_full()) << texels;
      EXPECT_EQ(p.first, glm::vec2(0.3f, 0.4f));
    }
}

TEST(Probes, TakeTheLevelWhoseTexelsThePixelCovers) {
  for (int level = 1; level < 7; ++level) {
    const Footprint pixel = square(std::exp2(static_cast<float>(level)), 64);
    for (const Filter filter : {Filter::kNearest, Filter::kTrilinear, Filter::kAnisotropic}) {
      const Probes p = probes_of(pixel, {}, {0.5f, 0.5f}, 64, 64, 7, filter);
      EXPECT_EQ(p.count, 1);
      EXPECT_NEAR(static_cast<float>(p.fine) + p.t, static_cast<float>(level), 1e-5f);
    }
  }
  const Probes between = probes_of(square(3, 64), {}, {0.5f, 0.5f}, 64, 64, 7, Filter::kTrilinear);
  EXPECT_EQ(between.fine, 1);
  EXPECT_NEAR(between.t, std::log2(1.5f), 1e-5f);
  EXPECT_EQ(probes_of(square(3, 64), {}, {0.5f, 0.5f}, 64, 64, 7, Filter::kNearest).fine, 2);
}

// A plane that is seen from aside: fifteen texels deep and two wide, whichever way it is turned.
TEST(Probes, LieAlongTheLongerSideOfWhatIsCovered) {
  for (const float turn : {0.0f, 0.4f, 1.1f, 1.5707964f, 2.3f}) {
    const glm::vec2 along(std::cos(turn), std::sin(turn)), across(-along.y, along.x);
    // The pixel's own axes lie skew to those of the ellipse.
    const float s = std::sqrt(0.5f);
    const Footprint pixel{(15 * s * along + 2 * s * across) / 256.0f, (15 * s * along - 2 * s * across) / 256.0f};
    const Probes p = probes_of(pixel, {}, {0.5f, 0.5f}, 256, 256, 9, Filter::kAnisotropic);
    EXPECT_EQ(p.count, 8) << turn;
    EXPECT_NEAR(static_cast<float>(p.fine) + p.t, 1, 1e-4f);
    EXPECT_NEAR(std::abs(glm::dot(glm::normalize(p.step), along)), 1, 1e-4f);
    EXPECT_NEAR(glm::length(p.step) * 256, 15.0f / 8, 1e-3f);
    const glm::vec2 last = p.first + static_cast<float>(p.count - 1) * p.step;
    EXPECT_NEAR(glm::distance(0.5f * (p.first + last), glm::vec2(0.5f)), 0, 1e-6f);
    // Without places along it the longer side decides.
    EXPECT_NEAR(
        std::log2(15.0f),
        [&] {
          const Probes t = probes_of(pixel, {}, {0.5f, 0.5f}, 256, 256, 9, Filter::kTrilinear);
          return static_cast<float>(t.fine) + t.t;
        }(),
        1e-4f);
  }
}

TEST(Probes, AreBoundedForEveryFootprint) {
  for (const Filter filter : kFilters)
    for (const float a : {0.0f, 1e-38f, 1.0f, 1e10f, 1e30f, kInfinity, kNan})
      for (const float b : {0.0f, -1e-3f, 1e5f, -1e38f, kInfinity, kNan})
        for (const glm::vec2& scale : {glm::vec2(1, 1), glm::vec2(0, 3), glm::vec2(-2, 1e-9f)}) {
          scene::Texture texture;
          texture.uv_scale = scale;
          const Probes p = probes_of({{a, b}, {b, a}}, texture, {0.5f, 0.5f}, 37, 5, 6, filter);
          ASSERT_TRUE(p.count >= 1 && p.count <= kMostProbes) << a << " " << b;
          ASSERT_TRUE(p.fine >= 0 && p.t >= 0 && p.t <= 1) << a << " " << b;
          ASSERT_LE(p.t > 0 ? p.fine + 1 : p.fine, 5) << a << " " << b;
          ASSERT_FALSE(std::isnan(p.step.x) || std::isnan(p.step.y)) << a << " " << b;
        }
}

TEST(Levels, AreFullSizeNearbyAndTheMeanFarAway) {
  const auto image = grey(64, 64, checker);
  const scene::Texture texture{0};
  const Levels levels(image, texture, Meaning::kValues);
  EXPECT_EQ(levels.count(), 7);
  for (const Filter filter : kFilters)
    for (const glm::vec2& uv : {glm::vec2(0.1f, 0.9f), glm::vec2(0, 0), glm::vec2(-3.3f, 7.77f)}) {
      EXPECT_EQ(levels.number(uv, {}, filter), number_at(image, texture, uv));
      EXPECT_EQ(levels.number(uv, square(1, 64), filter), number_at(image, texture, uv));
      EXPECT_EQ(levels.color(uv, square(1, 64), filter), color_at(image, texture, uv));
      if (filter == Filter::kFull) EXPECT_EQ(levels.number(uv, square(9, 64), filter), number_at(image, texture, uv));
      else EXPECT_NEAR(levels.number(uv, square(9, 64), filter), 0.5f, 1e-6f);
    }
}

// Black and white in bytes is half the light, not half the number.
TEST(Levels, AverageLightAndNotItsCode) {
  scene::Image image{"", {2, 1, 4, {0, 0, 0, 0, 255, 255, 255, 255}, {}}};
  scene::Texture srgb{0, scene::Transfer::kSrgb};
  const Levels levels(image, srgb, Meaning::kValues);
  // 188 is the byte nearest to half: 0.503.
  EXPECT_NEAR(levels.color({0.5f, 0.5f}, square(2, 2), Filter::kTrilinear).g, 0.5f, 0.004f);
  srgb.channel = 3;  // opacity is not encoded: 127.5 of 255
  EXPECT_NEAR(Levels(image, srgb, Meaning::kValues).number({0.5f, 0.5f}, square(2, 2), Filter::kTrilinear), 0.5f,
              0.5f / 255 + 1e-6f);
  const scene::Texture linear{0};
  EXPECT_NEAR(Levels(image, linear, Meaning::kValues).color({0.5f, 0.5f}, square(2, 2), Filter::kTrilinear).g, 0.5f,
              0.5f / 255 + 1e-6f);
}

TEST(Levels, KeepScaleAndOffset) {
  const auto image = grey(8, 8, checker);
  scene::Texture texture{0};
  texture.scale = glm::vec3(4), texture.offset = glm::vec3(-1);
  EXPECT_NEAR(Levels(image, texture, Meaning::kValues).number({0.2f, 0.2f}, square(8, 8), Filter::kTrilinear), 1,
              1e-6f);
}

// Sizes that are no powers of two lose no row: the last level is the mean of all.
TEST(Levels, OfAnySizeEndInTheMean) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 7}, {5, 1}, {3, 3}, {13, 6}, {100, 37}}) {
    double sum = 0;
    const auto value = [](int x, int y) { return static_cast<float>(((x * 7 + y * 13) % 11) * 0.1); };
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) sum += static_cast<double>(value(x, y));
    const auto image = grey(width, height, value);
    const scene::Texture texture{0};
    const Levels levels(image, texture, Meaning::kValues);
    const Footprint all{{1000, 0}, {0, 1000}};
    for (const Filter filter : {Filter::kNearest, Filter::kTrilinear, Filter::kAnisotropic})
      EXPECT_NEAR(levels.number({0.3f, 0.6f}, all, filter), sum / (width * height), 1e-6) << width << " x " << height;
  }
}

TEST(Levels, TakeAThirdOfThePictureAtMost) {
  for (const int side : {2, 64, 256}) {
    scene::Image bytes{"", {side, side, 3, {}, {}}};
    bytes.texels.bytes.assign(static_cast<std::size_t>(3 * side * side), 100);
    const std::size_t texels = bytes.texels.count();
    const scene::Texture texture{0};
    EXPECT_LE(Levels(bytes, texture, Meaning::kValues).bytes(), texels * 3 / 3);
    EXPECT_LE(Levels(bytes, texture, Meaning::kNormals).bytes(), texels * 3 * sizeof(float) / 3);
    EXPECT_LE(Levels(bytes, texture, Meaning::kRoughness).bytes(), texels * sizeof(float) / 3 + 1);
  }
  // A single row can only be halved along: at most as many again.
  scene::Image row{"", {4096, 1, 1, {}, {}}};
  row.texels.bytes.assign(4096, 7);
  const scene::Texture texture{0};
  EXPECT_LE(Levels(row, texture, Meaning::kValues).bytes(), 4096u);
}

TEST(Levels, LeaveOutWhatIsNoNumber) {
  const auto image = grey(8, 8, [](int x, int y) { return x == 3 && y == 3 ? kNan : x == 4 ? kInfinity : 0.25f; });
  const scene::Texture texture{0};
  const Levels levels(image, texture, Meaning::kValues), rough(image, texture, Meaning::kRoughness);
  for (const Filter filter : {Filter::kNearest, Filter::kTrilinear, Filter::kAnisotropic})
    for (const float texels : {4.0f, 6.0f, 8.0f, 99.0f}) {
      const float near_the_rest = levels.number({0.45f, 0.45f}, square(texels, 8), filter);
      EXPECT_NEAR(near_the_rest, 0.25f, 1e-6f) << texels;
      EXPECT_NEAR(rough.number({0.45f, 0.45f}, square(texels, 8), filter), 0.25f, 1e-4f) << texels;
    }
  // Long and thin over full size: the places that are numbers count.
  EXPECT_NEAR(levels.number({0.5f, 0.1f}, {{1, 0}, {0, 0.1f}}, Filter::kAnisotropic), 0.25f, 1e-6f);
  const auto nothing = grey(4, 4, [](int, int) { return kNan; });
  EXPECT_TRUE(std::isnan(Levels(nothing, texture, Meaning::kValues).number({0, 0}, square(4, 4), Filter::kTrilinear)));
}

TEST(Levels, RepeatOrEndAtTheEdges) {
  // White at the left, black at the right.
  const auto image = grey(16, 16, [](int x, int) { return x < 8 ? 1.0f : 0.0f; });
  scene::Texture texture{0};
  const Levels repeats(image, texture, Meaning::kValues);
  scene::Texture clamped = texture;
  clamped.wrap = scene::Wrap::kClamp;
  const Levels ends(image, clamped, Meaning::kValues);
  for (const Filter filter : {Filter::kNearest, Filter::kTrilinear, Filter::kAnisotropic}) {
    EXPECT_NEAR(repeats.number({0, 0.5f}, square(4, 16), filter), 0.5f, 1e-6f);
    EXPECT_NEAR(ends.number({0, 0.5f}, square(4, 16), filter), 1, 1e-6f);
    EXPECT_NEAR(ends.number({1, 0.5f}, square(4, 16), filter), 0, 1e-6f);
    EXPECT_NEAR(repeats.number({1.25f, 0.5f}, square(2, 16), filter),
                repeats.number({0.25f, 0.5f}, square(2, 16), filter), 1e-6f);
  }
  // Places along a footprint that crosses the edge: half of them on either side.
  EXPECT_NEAR(repeats.number({1, 0.5f}, {{0.5f, 0}, {0, 1.0f / 16}}, Filter::kAnisotropic), 0.5f, 0.1f);
}

// Along the stripes of a pattern a thin pixel keeps them; levels alone wash them out.
TEST(Levels, KeepAcrossAThinPixelWhatItDoesNotAverage) {
  const auto image = grey(64, 64, [](int, int y) { return y % 8 < 4 ? 1.0f : 0.0f; });
  const scene::Texture texture{0};
  const Levels levels(image, texture, Meaning::kValues);
  const Footprint thin{{16.0f / 64, 0}, {0, 1.0f / 64}};
  const glm::vec2 in_a_stripe{0.5f, 2.0f / 64};
  EXPECT_NEAR(levels.number(in_a_stripe, thin, Filter::kAnisotropic), 1, 1e-6f);
  EXPECT_NEAR(levels.number(in_a_stripe, thin, Filter::kTrilinear), 0.5f, 1e-6f);
}

// Two halves that lean apart by an angle: the mean of unit vectors is cos of half of it.
TEST(Levels, OfNormalsAreShorterByWhatTheyDiffer) {
  for (const double lean : {0.05, 0.3, 0.8}) {
    const auto x = static_cast<float>(std::sin(lean)), z = static_cast<float>(std::cos(lean));
    scene::Image image{"", {2, 2, 3, {}, {}}};
    for (int i = 0; i < 4; ++i)
      for (const float c : {i % 2 == 0 ? x : -x, 0.0f, z}) image.texels.floats.push_back(0.5f + 0.5f * c);
    const scene::Texture texture{0};
    const Levels levels(image, texture, Meaning::kNormals);
    const auto far = levels.normal({0.5f, 0.5f}, square(2, 2), Filter::kTrilinear);
    EXPECT_NEAR(far.deficit, 1 - std::cos(lean), 2e-7);
    EXPECT_NEAR(far.normal.z, 1, 1e-6f);
    const auto near = levels.normal({0.25f, 0.25f}, square(1, 2), Filter::kTrilinear);
    EXPECT_EQ(near.deficit, 0);
    EXPECT_NEAR(near.normal.x, x, 1e-6f);
    // Half the strength: half the slope.
    const auto flatter =
        Levels(image, texture, Meaning::kNormals, 0.5f).normal({0.5f, 0.5f}, square(2, 2), Filter::kTrilinear);
    EXPECT_NEAR(flatter.deficit, 1 - std::cos(std::atan(0.5 * std::tan(lean))), 2e-7);
  }
}

TEST(Levels, OfEqualNormalsAreAsLongAsOne) {
  scene::Image image{"", {16, 16, 3, {}, {}}};
  for (int i = 0; i < 256; ++i) image.texels.floats.insert(image.texels.floats.end(), {0.7f, 0.4f, 0.9f});
  const scene::Texture texture{0};
  const Levels levels(image, texture, Meaning::kNormals);
  for (const Filter filter : kFilters)
    for (const float texels : {1.0f, 1.7f, 5.0f, 16.0f, 1000.0f}) {
      const auto m = levels.normal({0.37f, 0.2f}, square(texels, 16), filter);
      EXPECT_NEAR(m.deficit, 0, 3e-7f);  // some rounding of a float: an alpha of 2e-4
      EXPECT_NEAR(glm::distance(m.normal, normal_at(image, texture, {0.37f, 0.2f}, 1)), 0, 1e-6f);
    }
}

TEST(Levels, OfNormalsThatCancelFaceOutwards) {
  scene::Image image{"", {2, 1, 3, {}, {1, 0.5f, 0.5f, 0, 0.5f, 0.5f}}};  // along x, and against it
  const scene::Texture texture{0};
  const auto m = Levels(image, texture, Meaning::kNormals).normal({0.5f, 0.5f}, square(2, 2), Filter::kTrilinear);
  EXPECT_NEAR(m.normal.z, 1, 1e-3f);
  EXPECT_GT(m.deficit, 0.99f);
}

// Rough and smooth: the mean of what they shorten normals by, not of the numbers.
TEST(Levels, OfRoughnessAverageWhatNormalsLose) {
  const auto image = grey(2, 2, [](int x, int) { return x == 0 ? 0.2f : 0.8f; });
  const scene::Texture texture{0};
  const Levels levels(image, texture, Meaning::kRoughness);
  const double deficit = 0.5 * (brdf::normal_deficit(0.04) + brdf::normal_deficit(0.64));
  EXPECT_NEAR(levels.number({0.5f, 0.5f}, square(2, 2), Filter::kTrilinear),
              std::sqrt(brdf::alpha_of_normal_deficit(deficit)), 1e-5);
  EXPECT_EQ(levels.number({0.25f, 0.5f}, {}, Filter::kTrilinear), 0.2f);
}

}  // namespace
}  // namespace likeness::texture
