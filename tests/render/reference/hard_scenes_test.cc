#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/render/reference/small_scenes.h"

// Scenes that something is wrong with: every pixel is a number, and the picture ends.
namespace likeness::reference {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

scene::Scene hard_stage() {
  scene::Scene scene;
  scene.meshes = {square_mesh(), sphere_mesh(), box_mesh()};
  brdf::Callisto<double> callisto;
  scene.materials = {material_of(lambert(0.6)), material_of(callisto)};
  scene.instances = {
      {"", 0, 0, placed({0, -1, 0}, 5)}, {"", 1, 1, placed({-1, 0, 0})}, {"", 2, 1, placed({1, 0, 0}, 0.5f)}};
  scene.lights = {{"", scene::SphereLight{{0, 2.5f, 1}, 0.3f, {20, 10, 5}}}};
  scene.environment = scene::Environment{scene::kNone, {0.2f, 0.3f, 0.4f}, 0};
  scene.cameras = {camera_at({0, 0.5f, 5}, {0, 0, 0}, 16, 16, 1)};
  return scene;
}
Rendered expect_numbers(const char* what, const scene::Scene& scene, double most_rejected = 0) {
  SCOPED_TRACE(what);
  auto r = rendered(scene, {.samples = 16, .has_layers = true});
  const image::Layers layers = r.film.layers();
  for (const auto& layer : layers.layers)
    for (const float x : layer.data) EXPECT_TRUE(std::isfinite(x)) << layer.name;
  for (const float x : r.picture.rgb) EXPECT_GE(x, 0);
  EXPECT_LE(static_cast<double>(r.film.rejected()), most_rejected * 16 * 16 * 16);
  return r;
}

scene::Image bad_image() {
  return {"bad", {4, 2, 3, {}, {kNan, kInfinity, -1,   0.5f, 0.5f, 0.5f, 1e38f, 0,    0, -kInfinity, 2, 3,
                                0.1f, 0.2f,      0.3f, kNan, kNan, kNan, 0.5f,  0.5f, 1, 0,          0, 0}}};
}

TEST(HardScenes, TexturesThatAreNoNumbersMakeNoPixelThatIsNone) {
  auto scene = hard_stage();
  scene.images = {bad_image()};
  const scene::Texture texture{0};
  for (std::size_t i = 0; i < brdf::Callisto<double>::kParameters.size(); ++i)
    scene.materials[1].bindings.push_back({i, texture});
  expect_numbers("parameters", scene);
  scene = hard_stage();
  scene.images = {bad_image()};
  scene.materials[0].normal_map = scene.materials[1].normal_map = texture;
  expect_numbers("normals", scene);
  scene.materials[1].diffuse_normal_map = texture;
  expect_numbers("dual normals", scene);
  scene.materials[1].opacity = texture;
  expect_numbers("opacity", scene);
  scene = hard_stage();
  scene.images = {bad_image()};
  scene.materials[1].emission = {1, 1, 1}, scene.materials[1].emission_map = texture;
  expect_numbers("emission", scene, 1);
  scene = hard_stage();
  scene.images = {bad_image()};
  scene.environment->image = 0;
  expect_numbers("environment", scene, 1);
}

TEST(HardScenes, ATexelOfTheSkyThatIsNoNumberCostsItsOwnLightOnly) {
  auto scene = hard_stage();
  scene.images = {{"sky", {16, 8, 1, {}, std::vector<float>(128, 1.0f)}}};
  scene.environment->image = 0;
  const double good = rendered(scene, {.samples = 64}).mean.g;
  scene.images[0].texels.floats[16 * 2 + 3] = kNan;
  const double bad = rendered(scene, {.samples = 64}).mean.g;
  EXPECT_NEAR(bad, good, 0.1 * good);
}

TEST(HardScenes, TrianglesAndLightsWithoutAreaAreNothing) {
  auto scene = hard_stage();
  scene.meshes[2].triangles = {{0, 0, 0}, {0, 1, 1}, {0, 1, 2}};
  scene.meshes[2].positions[2] = scene.meshes[2].positions[1];
  scene.materials[1].emission = {1, 1, 1};
  scene.lights.push_back({"", scene::RectangleLight{{0, 2, 0}, {0, 0, 0}, {0, 0, 1}, {5, 5, 5}}});
  scene.lights.push_back({"", scene::RectangleLight{{0, 2, 0}, {1, 0, 0}, {1, 0, 0}, {5, 5, 5}}});
  scene.lights.push_back({"", scene::DiskLight{{0, 2, 0}, {0, -1, 0}, 0, {5, 5, 5}}});
  scene.lights.push_back({"", scene::SphereLight{{0, 2, 0}, 0, {5, 5, 5}}});
  scene.lights.push_back({"", scene::PointLight{{0, -1, 0}, {5, 5, 5}}});  // on the floor
  scene.lights.push_back({"", scene::SpotLight{{0, 3, 0}, {0, -1, 0}, {1, 1, 1}, 0, 0}});
  for (const bool two_sided : {false, true}) {
    std::get<scene::RectangleLight>(scene.lights[1].shape).two_sided = two_sided;
    std::get<scene::DiskLight>(scene.lights[3].shape).two_sided = two_sided;
    expect_numbers("no area", scene);
  }
}

TEST(HardScenes, CamerasInsideOfThingsSeeTheirInside) {
  for (const glm::vec3& from :
       {glm::vec3(-1, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 2.5f, 1), glm::vec3(0, -1, 0), glm::vec3(-2, 0, 0)}) {
    auto scene = hard_stage();
    scene.cameras = {camera_at(from, from + glm::vec3(0.1f, 0.2f, -1), 16, 16, 1)};
    expect_numbers("inside", scene);
  }
}

TEST(HardScenes, ThinFarAndHugeThingsEnd) {
  auto scene = hard_stage();
  scene.instances[0].world_from_object = placed({0, -1, 0}, 1e8f);
  scene.instances[1].world_from_object = placed({-1, 0, 0}, 1e-4f);
  scene.instances[2].world_from_object = glm::scale(glm::mat4(1), glm::vec3(1e-12f, 1, 1));
  expect_numbers("huge, small and flat", scene);
  scene = hard_stage();
  for (auto& instance : scene.instances) instance.world_from_object[3] += glm::vec4(1e6f, 1e6f, 0, 0);
  scene.cameras = {camera_at({1e6f, 1e6f, 5}, {1e6f, 1e6f, 0}, 16, 16, 1)};
  expect_numbers("1000 km away", scene);
}

TEST(HardScenes, WithNothingAtAllAreBlack) {
  scene::Scene scene;
  scene.cameras = {camera_at({0, 0, 5}, {0, 0, 0}, 4, 4, 1)};
  EXPECT_EQ(expect_numbers("nothing", scene).mean.g, 0);
}

TEST(HardScenes, MirrorsThatFaceEachOtherEnd) {
  auto scene = hard_stage();
  brdf::Callisto<double> mirror;
  mirror.metallic = 1, mirror.roughness = 0, mirror.base_color = brdf::Rgb<double>(1.0);
  scene.materials = {material_of(mirror), material_of(mirror)};
  scene.instances = {{"", 2, 0, placed({0, 0, 0}, 2)}};
  scene.lights.clear(), scene.environment.reset();
  scene.cameras = {camera_at({0, 0.5f, 1}, {1, 0, 0}, 8, 8, 1)};
  EXPECT_EQ(expect_numbers("mirrors", scene).mean.g, 0);
}

// ---- the plan leaves out only what changes nothing

void expect_same_if_forced(const char* what, const scene::Scene& scene) {
  SCOPED_TRACE(what);
  const auto planned = rendered(scene, {.samples = 16}), forced = rendered(scene, {.samples = 16}, true);
  for (std::size_t i = 0; i < planned.picture.rgb.size(); ++i)
    ASSERT_NEAR(forced.picture.rgb[i], planned.picture.rgb[i], 1e-6f * (1 + planned.picture.rgb[i])) << i;
}

TEST(Force, OfAllEffectsLeavesThePictureAsItIs) {
  auto scene = hard_stage();
  expect_same_if_forced("light and sky", scene);
  scene.lights.clear();
  expect_same_if_forced("one color of sky", scene);
  scene.environment.reset();
  expect_same_if_forced("darkness", scene);
  scene = hard_stage();
  scene.environment.reset();
  expect_same_if_forced("one light", scene);
  scene.lights = {{"", scene::PointLight{{0, 2, 2}, {3, 3, 3}}}};
  expect_same_if_forced("a point", scene);
  scene.materials[1].emission = {1, 1, 1};
  expect_same_if_forced("emission", scene);
  scene = hard_stage();
  brdf::Callisto<double> metal;
  metal.metallic = 1;
  scene.materials[1] = material_of(metal);
  expect_same_if_forced("metal", scene);
  metal.dual_specular_opacity = 0.3;
  scene.materials[1] = material_of(metal);
  expect_same_if_forced("metal with two lobes", scene);
  brdf::Callisto<double> skin;
  skin.retroreflection = 5, skin.smooth_terminator = -0.4;
  scene.materials[1] = material_of(skin);
  expect_same_if_forced("some parts", scene);
  scene = hard_stage();
  scene.cameras[0].lens_radius = 0.1f, scene.cameras[0].focus_distance = 5;
  expect_same_if_forced("a lens", scene);
}

}  // namespace
}  // namespace likeness::reference
