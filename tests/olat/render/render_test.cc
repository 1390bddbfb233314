#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "datasets_synthetic/capture.h"
#include "olat/render/from_normals.h"
#include "olat/render/from_scene.h"
#include "olat/render/pairs.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/pixels.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "tests/render/temporary_folder.h"

namespace likeness::olat_render {
namespace {

using likeness::test::TemporaryFolder;
using testing::HasSubstr;

const auto kGo = [](double) {};

datasets_synthetic::CaptureOptions lambert_ball(const std::filesystem::path& folder) {
  datasets_synthetic::CaptureOptions out;
  out.folder = folder;
  out.width = out.height = 64;
  out.lights = 12;
  out.has_floats = true;
  brdf::Lambert<double> lambert;
  lambert.base_color = {0.2, 0.5, 0.8};
  out.brdf = lambert;
  return out;
}

TEST(FromNormals, FindsTheColorOfALambertSurfaceAndItsPhotographs) {
  const TemporaryFolder folder;
  for (const bool has_near_lights : {false, true}) {
    auto options = lambert_ball(folder / (has_near_lights ? "near" : "far"));
    options.has_near_lights = has_near_lights;
    const capture::Capture capture = datasets_synthetic::make_capture(options).capture;
    const NormalRenderer renderer(capture, 0, std::nullopt, kGo);
    // The middle of the ball, away from edges, which a pixel's nine samples blur.
    const auto color = renderer.colors().at(32, 32);
    EXPECT_NEAR(color[0], 0.2, 0.002);
    EXPECT_NEAR(color[1], 0.5, 0.005);
    EXPECT_NEAR(color[2], 0.8, 0.008);
    for (std::size_t light = 0; light < 12; ++light) {
      const auto want = capture::read_photo(capture, light).light.at(32, 30);
      // 0.16 faces the light; where light grazes, the nine samples of a pixel are not the one at its middle.
      EXPECT_NEAR(renderer.render(light).at(32, 30)[1], want[1], 0.01f * want[1] + 0.002f) << light;
    }
  }
}

TEST(FromNormals, ALightOrNormalsThatAreNotThereAreNamed) {
  const TemporaryFolder folder;
  capture::Capture capture = datasets_synthetic::make_capture(lambert_ball(folder / "c")).capture;
  capture.lights[3].place = {};
  try {
    NormalRenderer(capture, 0, std::nullopt, kGo);
    FAIL();
  } catch (const files::UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("light \"l03\" has no place"));
  }
  capture.layers.clear();
  EXPECT_THROW(NormalRenderer(capture, 0, std::nullopt, kGo), files::InputError);
}

TEST(Pairs, WhatIsWholeAndOfTheSameDigestIsKept) {
  const TemporaryFolder folder;
  const capture::Capture capture = datasets_synthetic::make_capture(lambert_ball(folder / "c")).capture;
  const capture::Variant variant{"v", "renders/{variant}/{camera}/{light}.exr"};
  const auto pairs = pairs_of(capture, "", "", false);
  ASSERT_EQ(pairs.size(), 12u);
  std::string digest = "one";
  const auto digest_of = [&](const Pair&) { return digest; };
  const auto render = [](const Pair&, const auto&) { return image::Picture(64, 64); };
  EXPECT_EQ(make_pairs(capture, variant, pairs, digest_of, render).made, 12u);
  EXPECT_EQ(make_pairs(capture, variant, pairs, digest_of, render).kept, 12u);
  // A file that was cut off is made again; so is one of another light that was copied here.
  const auto file = render_file(capture, variant, 0, 5);
  const std::string bytes = files::read_whole(file, 1 << 24);
  files::write_whole(file, bytes.substr(0, bytes.size() / 2));
  std::filesystem::copy_file(render_file(capture, variant, 0, 1), render_file(capture, variant, 0, 2),
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(make_pairs(capture, variant, pairs, digest_of, render).made, 2u);
  digest = "two";
  EXPECT_EQ(make_pairs(capture, variant, pairs, digest_of, render).made, 12u);
  EXPECT_EQ(pairs_of(capture, "c0", "l03", false).size(), 1u);
  EXPECT_THROW(pairs_of(capture, "c0", "l3", false), files::UsageError);
}

TEST(Pairs, AnInterruptionWithinAPictureLeavesTheOthers) {
  const TemporaryFolder folder;
  const capture::Capture capture = datasets_synthetic::make_capture(lambert_ball(folder / "c")).capture;
  const capture::Variant variant{"v", "renders/{variant}/{camera}/{light}.exr"};
  int count = 0;
  const Done done = make_pairs(
      capture, variant, pairs_of(capture, "", "", false), [](const Pair&) { return std::string("d"); },
      [&](const Pair&, const auto&) {
        if (++count == 4) throw files::Interrupted();
        return image::Picture(64, 64);
      });
  EXPECT_TRUE(done.is_interrupted);
  EXPECT_EQ(done.made, 3u);
  EXPECT_FALSE(std::filesystem::exists(render_file(capture, variant, 0, 3)));
}

// The path tracer on a ball and floor that the same capture describes: the pixels of the synthetic photographs.
TEST(FromScene, ASceneLooksAsItsPhotographs) {
  const TemporaryFolder folder;
  for (const bool has_near_lights : {false, true}) {
    auto options = lambert_ball(folder / (has_near_lights ? "near" : "far"));
    options.has_near_lights = has_near_lights;
    options.lights = 3;
    const capture::Capture capture = datasets_synthetic::make_capture(options).capture;
    scene::Scene scene;
    scene::Mesh ball;
    ball.is_sphere = true;
    scene.meshes = {ball};
    scene::Material paint;
    paint.brdf = options.brdf;
    scene.materials = {paint};
    scene::Instance instance;
    instance.mesh = instance.material = 0;
    instance.world_from_object = glm::mat4(0.1f);
    instance.world_from_object[3][3] = 1;
    scene.instances = {instance};
    scene.environment = scene::Environment{};  // is left out
    for (const bool is_runtime : {false, true}) {
      const SceneRenderer renderer(scene, {.is_runtime = is_runtime, .samples = 16});
      for (std::size_t light = 0; light < 3; ++light) {
        const image::Picture got = renderer.render(capture, 0, light, [](double) { return true; });
        const image::Picture want = capture::read_photo(capture, light).light;
        for (const auto& [x, y] : {std::pair{32, 32}, {28, 28}, {36, 26}})
          EXPECT_NEAR(got.at(x, y)[2], want.at(x, y)[2], 0.02f * want.at(x, y)[2] + 1e-4f)
              << x << ' ' << y << " light " << light << (is_runtime ? " runtime" : "");
      }
    }
  }
}

// A ball of 0.1 m about the origin, in which an orthographic camera's plane lies: it is seen whole, as wide as it is, and by
// both integrators as the formula has it.
TEST(FromScene, AnOrthographicCameraSeesTheBallWholeAndAsWideAsItIs) {
  constexpr double kPixelsPerMeter = 200;
  capture::Capture capture;
  capture::Camera camera;
  camera.id = "c";
  camera.width = camera.height = 64;
  camera.is_orthographic = true;
  camera.intrinsics = glm::dmat3(kPixelsPerMeter, 0, 0, 0, kPixelsPerMeter, 0, 32, 32, 1);
  camera.world_from_camera = glm::dmat4(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
  capture.cameras = {camera};
  const glm::dvec3 to_light = glm::normalize(glm::dvec3(0.4, 0.3, 1));
  capture.lights = {{"l", "", capture::DistantLight{to_light}, {1, 1, 1}, ""}};
  scene::Scene scene;
  scene::Mesh ball;
  ball.is_sphere = true;
  scene.meshes = {ball};
  scene::Material paint;
  brdf::Lambert<double> grey;
  grey.base_color = brdf::Rgb<double>(0.5);
  paint.brdf = grey;
  scene.materials = {paint};
  scene::Instance instance;
  instance.mesh = instance.material = 0;
  instance.world_from_object = glm::mat4(0.1f);
  instance.world_from_object[3][3] = 1;
  scene.instances = {instance};
  for (const bool is_runtime : {false, true}) {
    const image::Picture got =
        SceneRenderer(scene, {.is_runtime = is_runtime, .samples = 16}).render(capture, 0, 0, [](double) {
          return true;
        });
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const double u = (x + 0.5 - 32) / kPixelsPerMeter, v = (32 - y - 0.5) / kPixelsPerMeter,
                     r = std::hypot(u, v) / 0.1;
        const glm::dvec3 normal(u / 0.1, v / 0.1, std::sqrt(std::max(0.0, 1 - r * r)));
        const double want = r < 1 ? 0.5 / std::numbers::pi * std::max(0.0, glm::dot(normal, to_light)) : 0;
        if (std::abs(r - 1) < 0.06) continue;  // a pixel is 1/20 of the radius
        // Within a pixel the cosine bends, and at the shadow's line it has a kink.
        ASSERT_NEAR(got.at(x, y)[1], want, 0.004) << x << ' ' << y << (is_runtime ? " runtime" : "");
      }
  }
}

TEST(FromScene, WhatAScenesCameraCannotDoIsRefused) {
  capture::Camera camera;
  camera.id = "c";
  camera.width = camera.height = 1;
  EXPECT_NO_THROW(camera_of(camera));
  camera.is_undistorted = false;
  EXPECT_THROW(camera_of(camera), files::UsageError);
  EXPECT_THROW(light_of(capture::Light{}), files::UsageError);
}

}  // namespace
}  // namespace likeness::olat_render
