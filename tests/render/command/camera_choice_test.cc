#include "render/command/camera_choice.h"

#include <gtest/gtest.h>

#include "render/command/integrators.h"
#include "render/command/request.h"
#include "render/command/scene_digest.h"
#include "render/files/files.h"
#include "render/world/camera.h"

namespace likeness::render_command {
namespace {

scene::Scene two_cameras() {
  scene::Scene s;
  s.cameras.resize(2);
  s.cameras[0].name = "front", s.cameras[1].name = "0";
  return s;
}
template <class F>
std::string refusal(F&& f) {
  try {
    f();
  } catch (const files::UsageError& e) {
    return e.what();
  }
  return "";
}

TEST(CameraChoice, TakesNamesBeforeNumbers) {
  EXPECT_EQ(camera_of(two_cameras(), ""), 0u);
  EXPECT_EQ(camera_of(two_cameras(), "front"), 0u);
  EXPECT_EQ(camera_of(two_cameras(), "0"), 1u) << "that is its name";
  EXPECT_EQ(camera_of(two_cameras(), "1"), 1u);
}
TEST(CameraChoice, SaysWhichCamerasThereAre) {
  EXPECT_EQ(refusal([] { camera_of(two_cameras(), "frnt"); }),
            "--camera \"frnt\": the scene has \"front\", \"0\" (or by number, 0 to 1); did you mean front?");
  for (const char* wanted : {"2", "-1", "1.0", "0x0"})
    EXPECT_NE(refusal([&] { camera_of(two_cameras(), wanted); }), "") << wanted;
}

TEST(PictureSize, IsReadOrRefused) {
  EXPECT_EQ(size_of("640x360").width, 640);
  EXPECT_EQ(size_of("640X360").height, 360);
  for (const char* text : {"", "x", "640", "640x", "x360", "640x360x2", "-1x5", "0x5", "5x0", "1e3x2", "640 x 360",
                           "65537x1", "16385x16384", "99999999999999999999x1", "65536x65536"})
    EXPECT_NE(refusal([&] { size_of(text); }).find("--size \"" + std::string(text)), std::string::npos) << text;
}

// What is seen at the middle of the top and the bottom edge stays; pixels stay square.
TEST(PictureSize, KeepsTheVerticalFieldOfView) {
  scene::Camera camera;
  camera.width = 400, camera.height = 200, camera.focal_x = 250, camera.focal_y = 300;
  camera.center_x = 210, camera.center_y = 90;
  scene::Camera other = camera;
  resize(other, {900, 600});
  EXPECT_EQ(other.width, 900);
  EXPECT_EQ(other.height, 600);
  for (const float share : {0.f, 0.5f, 1.f}) {
    const auto a = world::Camera(camera).ray({camera.center_x, share * 200}).direction;
    const auto b = world::Camera(other).ray({other.center_x, share * 600}).direction;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-6) << share;
  }
  EXPECT_DOUBLE_EQ(other.focal_x / other.focal_y, 250.0 / 300);
  // The optical axis is as far from the middle, in heights of the picture.
  EXPECT_DOUBLE_EQ((other.center_x - 450) / 600, (camera.center_x - 200) / 200);
  resize(other, {400, 200});
  EXPECT_DOUBLE_EQ(other.center_x, camera.center_x);
  EXPECT_DOUBLE_EQ(other.focal_y, camera.focal_y);
}

TEST(PictureMemory, GrowsWithWhatIsAskedForAndIsRefusedBeyondTheMachine) {
  scene::Camera camera;
  camera.width = camera.height = 1000;
  const std::size_t plain = picture_bytes(camera, false, 0);
  EXPECT_GT(plain, 100'000'000u);
  EXPECT_LT(plain, 500'000'000u);
  EXPECT_GT(picture_bytes(camera, true, 0), 2 * plain);
  EXPECT_EQ(picture_bytes(camera, false, 10) - plain, 320'000'000u);
  EXPECT_EQ(refusal([&] { check_memory(camera, false, 0, plain); }), "");
  const std::string text = refusal([&] { check_memory(camera, true, 2, plain); });
  for (const char* word : {"--size 1000x1000", "GB", "smaller", "--layers"})
    EXPECT_NE(text.find(word), std::string::npos) << text;
  EXPECT_GT(memory_of_machine(), std::size_t{100} << 20);
}

TEST(RenderPaths, AreBesideThePicture) {
  Request r;
  r.scene = "rooms/room.json";
  const Paths p = paths_of(r);
  EXPECT_EQ(p.picture, "room.exr");
  EXPECT_EQ(p.png, "room.png");
  EXPECT_EQ(p.state, "room.state.exr");
  r.out = "out/a.b.exr", r.no_png = true;
  EXPECT_EQ(paths_of(r).state, "out/a.b.state.exr");
  EXPECT_TRUE(paths_of(r).png.empty());
}

TEST(RenderOptions, HaveNoLimitOfSamplesButAnotherEnd) {
  Request r;
  EXPECT_EQ(options_of(r).samples, 64u);
  r.seconds = 5;
  EXPECT_EQ(options_of(r).samples, 65536u);
  r.samples = 3;
  EXPECT_EQ(options_of(r).samples, 3u);
}

TEST(SceneDigest, IsOfWhatThePictureDependsOn) {
  scene::Scene s = two_cameras();
  s.meshes.emplace_back().positions = {{0, 0, 0}, {1, 0, 0}};
  s.materials.emplace_back().name = "paint";
  s.instances.push_back({"a", 0, 0, glm::mat4(1)});
  s.lights.push_back({"lamp", scene::PointLight{}});
  s.images.push_back({"a.png", {1, 1, 1, {7}, {}}});
  const std::string before = digest_of(s, 0);

  scene::Scene same = s;
  same.name = "x", same.view.ev = 3, same.cameras[1].width = 7, same.materials[0].name = "y", same.lights[0].name = "z";
  same.lights[0].is_movable = true;
  EXPECT_EQ(digest_of(same, 0), before);

  const auto changes = [&](const char* what, auto&& edit) {
    scene::Scene other = s;
    edit(other);
    EXPECT_NE(digest_of(other, 0), before) << what;
  };
  changes("camera", [](auto& o) { o.cameras[0].focal_x += 1; });
  changes("size", [](auto& o) { o.cameras[0].width += 1; });
  changes("vertex", [](auto& o) { o.meshes[0].positions[1].y = 1; });
  changes("sphere", [](auto& o) { o.meshes[0].is_sphere = true; });
  changes("parameter", [](auto& o) { std::get<0>(o.materials[0].brdf).roughness = 0.1; });
  changes("color", [](auto& o) { std::get<0>(o.materials[0].brdf).base_color.b = 0.1; });
  changes("model", [](auto& o) { o.materials[0].brdf = brdf::Lambert<double>{}; });
  changes("texture", [](auto& o) { o.materials[0].normal_map = scene::Texture{.image = 0}; });
  changes("binding", [](auto& o) { o.materials[0].bindings.push_back({0, {.image = 0}}); });
  changes("emission", [](auto& o) { o.materials[0].emission.r = 1; });
  changes("sides", [](auto& o) { o.materials[0].two_sided = false; });
  changes("place", [](auto& o) { o.instances[0].world_from_object[3].x = 1; });
  changes("texel", [](auto& o) { o.images[0].texels.bytes[0] = 8; });
  changes("light", [](auto& o) { std::get<0>(o.lights[0].shape).intensity.g = 2; });
  changes("kind of light", [](auto& o) { o.lights[0].shape = scene::SphereLight{}; });
  changes("range", [](auto& o) { o.lights[0].range = 2; });
  changes("environment", [](auto& o) { o.environment.emplace(); });
}

}  // namespace
}  // namespace likeness::render_command
