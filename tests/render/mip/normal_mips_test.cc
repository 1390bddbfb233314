#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "brdf/normal_length.h"
#include "render/texture/normal_mips.h"

namespace likeness::texture {
namespace {

scene::Image picture(int width, int height, const auto& normal_at) {
  scene::Image out;
  out.texels.width = width, out.texels.height = height, out.texels.channels = 3;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::vec3 n = glm::normalize(normal_at(x, y));
      for (int k = 0; k < 3; ++k) out.texels.floats.push_back(0.5f * n[k] + 0.5f);
    }
  return out;
}
RoughnessBelow everywhere(float roughness) {
  RoughnessBelow below;
  below.everywhere = roughness;
  return below;
}

TEST(NormalMips, AFlatMapKeepsItsRoughnessAtEveryLevel) {
  const scene::Image flat = picture(16, 8, [](int, int) { return glm::vec3(0, 0, 1); });
  for (const float roughness : {0.02f, 0.3f, 1.0f}) {
    const auto levels = normal_mips(flat, {}, everywhere(roughness));
    ASSERT_EQ(levels.size(), 5u);  // 16x8, 8x4, 4x2, 2x1, 1x1
    for (const NormalMip& level : levels)
      for (std::size_t i = 0; i < level.normals.size(); ++i) {
        EXPECT_NEAR(level.roughness[i], roughness, 1e-6f * roughness);
        EXPECT_NEAR(glm::distance(level.normals[i], glm::vec3(0, 0, 1)), 0, 1e-6f);  // floats of the map
      }
  }
}

// Two tilts: the mean of the normals is known, and what it lost is the roughness.
TEST(NormalMips, WhatTiltsLoseInLengthIsRoughness) {
  const float tilt = 0.3f;
  const scene::Image waves = picture(
      8, 8, [&](int x, int) { return glm::vec3(x % 2 == 0 ? std::sin(tilt) : -std::sin(tilt), 0, std::cos(tilt)); });
  const auto levels = normal_mips(waves, {}, everywhere(0.1f));
  const double length = brdf::normal_length(0.01) * std::cos(static_cast<double>(tilt));
  const double expected = std::sqrt(brdf::alpha_of_normal_length(length));
  for (std::size_t k = 1; k < levels.size(); ++k)
    for (std::size_t i = 0; i < levels[k].normals.size(); ++i) {
      EXPECT_NEAR(levels[k].lengths[i], length, 1e-6);
      EXPECT_NEAR(levels[k].roughness[i], expected, 1e-5);  // floats of the map; 0.59 here
      EXPECT_NEAR(levels[k].normals[i].z, 1, 1e-6f);
    }
}

// Means of means are means: the last level is that of all texels, whatever the sides are.
TEST(NormalMips, TheLastLevelIsTheMeanOfAllTexels) {
  for (const auto& [width, height] : {std::pair{7, 5}, {13, 1}, {1, 9}, {6, 10}, {3, 3}}) {
    const auto at = [](int i, int j) {
      const auto x = static_cast<float>(i), y = static_cast<float>(j);
      return glm::vec3(std::sin(x * 1.7f + y), std::cos(y * 2.3f - x), 2.0f);
    };
    const scene::Image bumps = picture(width, height, at);
    const auto levels = normal_mips(bumps, {}, everywhere(0.2f));
    brdf::ShortenedNormals<double> all;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(at(x, y)));
        all.add({n.x, n.y, n.z}, 0.2);
      }
    const auto expected = all.filtered();
    ASSERT_EQ(levels.back().normals.size(), 1u);
    EXPECT_NEAR(levels.back().lengths[0], expected.length, 1e-6) << width << " x " << height;
    EXPECT_NEAR(levels.back().roughness[0], expected.roughness, 1e-5) << width << " x " << height;
    EXPECT_NEAR(levels.back().normals[0].x, expected.normal.x, 1e-5) << width << " x " << height;
  }
}

TEST(NormalMips, NormalsThatCancelAreAsRoughAsGgxCanBe) {
  const scene::Image opposed = picture(2, 1, [](int x, int) { return glm::vec3(x == 0 ? 1 : -1, 0, 1e-2f); });
  const auto levels = normal_mips(opposed, {}, everywhere(0.0f));
  EXPECT_EQ(levels.back().roughness[0], 1.0f);
  EXPECT_LT(levels.back().lengths[0], 0.02f);
}

TEST(NormalMips, TexelsThatAreNoNumbersCountAsFlat) {
  scene::Image broken = picture(4, 4, [](int, int) { return glm::vec3(0, 0, 1); });
  broken.texels.floats[5] = NAN, broken.texels.floats[20] = INFINITY;
  for (const NormalMip& level : normal_mips(broken, {}, everywhere(0.5f)))
    for (const float r : level.roughness) EXPECT_NEAR(r, 0.5f, 1e-3f);
}

TEST(NormalMips, RoughnessComesFromItsPicture) {
  const scene::Image flat = picture(4, 4, [](int, int) { return glm::vec3(0, 0, 1); });
  scene::Image rough;
  rough.texels.width = rough.texels.height = 4, rough.texels.channels = 3;
  for (int i = 0; i < 16; ++i) rough.texels.floats.insert(rough.texels.floats.end(), {0.1f, 0.6f, 0.9f});
  RoughnessBelow below;
  below.image = &rough, below.texture.channel = 1;
  for (const NormalMip& level : normal_mips(flat, {}, below))
    for (const float r : level.roughness) EXPECT_NEAR(r, 0.6f, 1e-6f);
}

}  // namespace
}  // namespace likeness::texture
