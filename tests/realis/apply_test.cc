#include "realis/apply.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace likeness::realis {
namespace {

image::Picture even(int width, int height, float value) {
  image::Picture p(width, height);
  std::fill(p.rgb.begin(), p.rgb.end(), value);
  return p;
}
glm::dvec3 sum_of(const std::vector<Beam>& beams) {
  glm::dvec3 sum(0);
  for (const Beam& b : beams) sum += b.irradiance;
  return sum;
}

TEST(Beams, KeepAllOfTheLight) {
  for (const std::size_t count :
       {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{256}, std::size_t{100000}}) {
    const std::vector<Beam> beams = beams_of(even(32, 16, 2), count);
    EXPECT_LE(beams.size(), count);
    EXPECT_NEAR(sum_of(beams).r, 2 * 4 * std::numbers::pi, 1e-9);
    for (const Beam& b : beams) EXPECT_NEAR(glm::length(b.to_light), 1, 1e-12);
  }
  EXPECT_EQ(beams_of(even(32, 16, 2), 100000).size(), 512u) << "no more than pixels";
}

// An even sky on a plane: pi times its radiance. 512 beams of a quantity that varies as a cosine: 1 %.
TEST(Beams, OfAnEvenSkyLightAPlaneAsTheSkyDoes) {
  for (const glm::dvec3& normal : {glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 0.6, 0.8)}) {
    double sum = 0;
    for (const Beam& b : beams_of(even(128, 64, 1), 512))
      sum += std::max(glm::dot(normal, b.to_light), 0.0) * b.irradiance.g;
    EXPECT_NEAR(sum, std::numbers::pi, 0.01 * std::numbers::pi);
  }
}

// Where the pictures of environments have their directions: the middle is -z, to its right +x, the top row +y.
TEST(Beams, ComeFromWhereThePixelIs) {
  const auto only = [](int x, int y) {
    image::Picture p(64, 32);
    for (const float& c : p.at(x, y)) const_cast<float&>(c) = 1;
    const auto beams = beams_of(p, 16);
    EXPECT_EQ(beams.size(), 1u);
    return beams.at(0).to_light;
  };
  EXPECT_NEAR(only(32, 16).z, -1, 0.01);
  EXPECT_NEAR(only(48, 16).x, 1, 0.01);
  EXPECT_NEAR(only(10, 0).y, 1, 0.01);
  EXPECT_NEAR(only(0, 16).z, 1, 0.01);
}

TEST(Beams, OfBlackAndOfWhatIsNoLightAreNone) {
  EXPECT_TRUE(beams_of(even(8, 4, 0), 16).empty());
  EXPECT_TRUE(beams_of(even(8, 4, -1), 16).empty());
  EXPECT_TRUE(beams_of(even(8, 4, std::numeric_limits<float>::quiet_NaN()), 16).empty());
  EXPECT_TRUE(beams_of({}, 16).empty());
  EXPECT_TRUE(beams_of(even(8, 4, 1), 0).empty());
}

// A surface that faces the camera, lit from there: the render is base color times exposure over pi (Callisto's defaults add
// their specular), the residual is what the bake says.
TEST(Relight, AddsTheResidualToTheRender) {
  capture::Capture capture;
  capture::Camera camera;
  camera.id = "c", camera.width = 2, camera.height = 1, camera.is_orthographic = true;
  camera.world_from_camera = glm::dmat4(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 1, 1);
  capture.cameras.push_back(camera);
  StoredBake s;
  s.width = 2, s.height = 1, s.pixels = {1};
  s.bake.basis.lobes = {{{0, 0, 1}, 4}};
  s.bake.basis.spread = {1};
  s.bake.kept = 1;
  s.bake.coefficients = {0.25f};
  capture_fit::Fit surface;
  surface.normals = image::Picture(2, 1), surface.base_colors = image::Picture(2, 1);
  surface.normals.rgb = {0, 0, 0, 0, 0, 1};
  surface.base_colors.rgb = {0, 0, 0, 0.5f, 0.5f, 0.5f};
  const Beam beam{{0, 0, 1}, {2, 1, 0}};
  const Relit relit = relight(capture, s, surface, std::span(&beam, 1));
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(relit.realis.rgb[c], 0) << "outside";
    EXPECT_NEAR(relit.realis.rgb[3 + c] - relit.render.rgb[3 + c], 0.25 * beam.irradiance[static_cast<int>(c)], 1e-6);
    EXPECT_EQ(relit.render.rgb[3 + c] > 0, beam.irradiance[static_cast<int>(c)] > 0);
  }
  s.bake.coefficients = {-9.0f};
  EXPECT_EQ(relight(capture, s, surface, std::span(&beam, 1)).realis.rgb[3], 0) << "light is not negative";
  surface.normals = image::Picture(3, 1);
  EXPECT_THROW(relight(capture, s, surface, std::span(&beam, 1)), std::runtime_error);
}

}  // namespace
}  // namespace likeness::realis
