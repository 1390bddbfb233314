#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "realis/weight/table.h"
#include "render/files/files.h"
#include "tests/realis/domes.h"

namespace likeness::realis::weight {
namespace {

// What Samples points to.
struct Held {
  std::vector<std::uint32_t> pixels;
  std::vector<glm::dvec3> lights, normals, views;
  std::vector<Color> photo, render;
  std::vector<float> cosine;
  std::vector<std::array<float, 2>> uv;
  int width, height;

  Held(int w, int h, std::size_t count, float value) : width(w), height(h) {
    lights = test::dome(count);
    for (int i = 0; i < w * h; ++i) pixels.push_back(static_cast<std::uint32_t>(i));
    normals.assign(pixels.size(), {0, 0, 1}), views = normals;
    photo.assign(pixels.size() * count, {value, value, value}), render = photo;
    for (std::size_t t = 0; t < pixels.size(); ++t)
      for (const glm::dvec3& l : lights) cosine.push_back(static_cast<float>(l.z));
  }
  Samples samples() const {
    Samples s;
    s.width = width, s.height = height, s.pixels = pixels, s.to_lights = lights, s.photo = photo, s.render = render;
    s.cosine = cosine, s.normals = normals, s.to_views = views, s.uv = uv;
    return s;
  }
};

TEST(WeightTable, OfHardCasesIsInItsRangeAndFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  for (const int side : {0, 1, 2, 7})
    for (const std::size_t lights : {0u, 1u, 2u, 9u})
      for (const float value : {0.0f, 0.5f, -1.0f, nan, infinite, 1e30f})
        for (const bool both : {true, false}) {
          Held held(side, side, lights, value);
          if (both) held.uv.assign(held.pixels.size(), {value, value});
          else held.render.assign(held.photo.size(), {1, 1, 1}), held.cosine.assign(held.photo.size(), value);
          for (const Row& row : kWeights) {
            if (row.make == nullptr) continue;
            const Weights weights = row.make(held.samples(), {});
            ASSERT_EQ(weights.size(), held.photo.size());
            for (const float w : weights) ASSERT_TRUE(w >= 0 && w <= 1) << row.name << " of " << value;
          }
        }
}

TEST(WeightTable, NamesWhatIsMeantByAWrongName) {
  const std::vector<std::string> wrong{"shadwo"}, mask{"mask"}, shadow_only{"shadow"};
  EXPECT_THROW(choice_of(wrong, {}, {}), files::UsageError);
  EXPECT_THROW(choice_of({}, {}, mask), files::UsageError);
  const Choice only = choice_of(shadow_only, {}, {});
  for (std::size_t i = 0; i < kWeights.size(); ++i)
    EXPECT_EQ(only.is_on[i], kWeights[i].make == nullptr || kWeights[i].name == "shadow") << kWeights[i].name;
  Settings settings;
  settings.shadow.full = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(choice_of({}, {}, {}, settings), files::UsageError);
}

// One light, a strip: the photo is dark up to `photo_edge`, the render up to `render_edge`; lit level from other lights.
Held strip(int photo_edge, int render_edge) {
  Held held(40, 3, 6, 0);
  for (std::size_t at = 0; at < held.photo.size(); ++at) {
    const float lit = held.cosine[at];
    held.photo[at] = held.render[at] = {lit, lit, lit};
    if (at % 6 != 0) continue;
    const int x = static_cast<int>(at / 6) % 40;
    if (x >= 10 && x < photo_edge) held.photo[at] = {0, 0, 0};
    if (x >= 10 && x < render_edge) held.render[at] = {0, 0, 0};
  }
  return held;
}

// The shadow begins at 10 in both. Between its two ends nothing counts, within it everything does: there, the contours on
// the two sides face each other.
TEST(ShadowWeight, FallsBetweenTheTwoContoursOnly) {
  const Held held = strip(20, 25);
  const Weights w = shadow(held.samples(), {});
  for (int x = 0; x < 40; ++x) {
    const float got = w[static_cast<std::size_t>(40 + x) * 6];
    if (x >= 20 && x < 25) {
      EXPECT_EQ(got, 0) << x;
    }
    if (x < 19 || x > 25) {
      EXPECT_EQ(got, 1) << x;
    }
    EXPECT_EQ(w[static_cast<std::size_t>(40 + x) * 6 + 1], 1) << "another light";
  }
}
TEST(ShadowWeight, IsOneWithoutASecondContourAndBeyondTheLongestWay) {
  for (const Held& held : {strip(20, 10), strip(10, 20), strip(20, 20)})
    for (const float w : shadow(held.samples(), {})) EXPECT_EQ(w, 1);
  for (const float w : shadow(strip(15, 38).samples(), {.longest = 8})) EXPECT_EQ(w, 1);
}
TEST(ShadowWeight, FallsWithTheWidthOfTheGap) {
  const auto least = [](double full) {
    const Weights w = shadow(strip(20, 22).samples(), {.full = full});
    return *std::min_element(w.begin(), w.end());
  };
  EXPECT_EQ(least(1), 0);
  EXPECT_NEAR(least(4), 1 - 1.9 / 3.9, 1e-6);  // two pixels, of which a tenth counts for nothing
}

// A plane whose texture is ten times denser on the right half. Light and view are at right angles: nothing is seen straight.
TEST(StretchWeight, FallsWhereTheTextureIsDrawnOut) {
  Held held(20, 4, 3, 0.5f);
  for (const std::uint32_t p : held.pixels) {
    const auto x = static_cast<float>(p % 20), y = static_cast<float>(p / 20);
    held.uv.push_back({x < 14 ? x : 14 + 10 * (x - 14), y});
  }
  held.lights = {{1, 0, 0}, {0, 0, 1}, {0, 0, -1}};
  const Weights w = stretch(held.samples(), {.a = 1, .b = 0.05});
  EXPECT_NEAR(w[3 * 2], 0.95, 1e-6);
  EXPECT_LT(w[3 * 18], 0.52);
  EXPECT_EQ(w[3 * 18 + 1], 1);
  EXPECT_EQ(w[3 * 18 + 2], 1);
  held.uv.clear();
  for (const float x : stretch(held.samples(), {.b = 100})) EXPECT_EQ(x, 1);
}

TEST(SensorWeights, LeaveShadowsThatTheRenderLacks) {
  Held held(4, 1, 2, 1.0f);
  held.photo[0] = {0, 0, 0};                        // a cast shadow
  held.photo[2] = held.render[2] = {0.001f, 0, 0};  // dark in both
  held.photo[4] = {std::numeric_limits<float>::quiet_NaN(), 0, 0};
  held.photo[6] = {0.1f, 3, 0.1f};
  EXPECT_EQ(black(held.samples(), {.level = 0.01}), (Weights{1, 1, 0, 1, 1, 1, 1, 1}));
  EXPECT_EQ(clipped(held.samples(), {.clip = 2}), (Weights{1, 1, 1, 1, 0, 1, 0, 1}));
}

// 5 x 5 texels under 3 lights.
TEST(SensorWeights, FindADeadPixelAndTheLightThatIsLost) {
  Held held(5, 5, 3, 1.0f);
  const std::size_t middle = 3 * 12;
  for (std::size_t l = 0; l < 3; ++l) held.photo[middle + l] = {0, 0, 0};
  Weights w = black(held.samples(), {});
  for (std::size_t i = 0; i < w.size(); ++i) EXPECT_EQ(w[i], i >= middle && i < middle + 3 ? 0 : 1) << i;
  std::fill(held.photo.begin(), held.photo.end(), Color{0, 0, 0});
  for (const float x : black(held.samples(), {})) EXPECT_EQ(x, 1) << "a subject in the dark is no dead pixel";
  // Below 0.02 the sensor says 0: what the render has there, too, is not known; what it has lit is a shadow.
  for (std::size_t i = 0; i < held.photo.size(); ++i) {
    const float x = 0.001f * static_cast<float>(i + 1), seen = x < 0.02f ? 0 : x;
    held.render[i] = {x, x, x}, held.photo[i] = {seen, seen, seen};
  }
  held.photo[70] = {0, 0, 0};
  w = black(held.samples(), {});
  for (std::size_t i = 0; i < w.size(); ++i) EXPECT_EQ(w[i], i < 19 ? 0 : 1) << i;
}

// A block of 4 x 4 that one of 12 lights sees brighter; smaller ones, highlights and cast shadows are no objects.
TEST(ForeignWeight, FindsRegionsThatAreNeitherHighlightsNorShadows) {
  const auto zeros = [](int size, float value, bool is_mirror) {
    Held held(16, 16, 12, 0);
    for (std::size_t at = 0; at < held.photo.size(); ++at) {
      const float lit = held.cosine[at];
      held.photo[at] = held.render[at] = {lit, lit, lit};
      const int x = static_cast<int>(at / 12) % 16, y = static_cast<int>(at / 12) / 16;
      if (at % 12 == 7 && x >= 5 && x < 5 + size && y >= 5 && y < 5 + size) held.photo[at] = {value, value, value};
    }
    if (is_mirror) held.normals.assign(held.pixels.size(), glm::normalize(held.lights[7] + glm::dvec3(0, 0, 1)));
    const Weights w = foreign(held.samples(), {});
    return std::count(w.begin(), w.end(), 0.0f);
  };
  EXPECT_EQ(zeros(4, 2, false), 36);  // with its rim
  EXPECT_EQ(zeros(2, 2, false), 0);
  EXPECT_EQ(zeros(4, 2, true), 0);
  EXPECT_EQ(zeros(4, 0, false), 0);
}
// As bright as what it hides, and of another color. What is only whiter is a highlight.
TEST(ForeignWeight, FindsAnObjectByItsColor) {
  const auto zeros = [](const Color& object) {
    Held held(16, 16, 12, 0);
    for (std::size_t at = 0; at < held.photo.size(); ++at) {
      const float lit = held.cosine[at];
      const Color usual{1.6f * lit, 0.88f * lit, 0.4f * lit};
      held.photo[at] = held.render[at] = usual;
      const int x = static_cast<int>(at / 12) % 16, y = static_cast<int>(at / 12) / 16;
      if (at % 12 == 7 && x >= 5 && x < 9 && y >= 5 && y < 9)
        held.photo[at] = {object[0] * lit, object[1] * lit, object[2] * lit};
    }
    const Weights w = foreign(held.samples(), {});
    return std::count(w.begin(), w.end(), 0.0f);
  };
  EXPECT_EQ(zeros({0.6f, 1.05f, 1.4f}), 36);
  EXPECT_EQ(zeros({1.1f, 0.98f, 0.9f}), 0);
}

}  // namespace
}  // namespace likeness::realis::weight
