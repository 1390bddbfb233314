#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/scene/ies.h"
#include "tests/render/scene/refusal.h"
#include "tests/render/scene/sound.h"

// What each key of a scene file becomes.
namespace likeness::scene::test {
namespace {

void expect_near(const glm::dvec3& got, const glm::dvec3& want) {
  constexpr double kFloat = 1e-6;  // of values near 1, some operations on
  EXPECT_LE(glm::length(got - want), kFloat * std::max(1.0, glm::length(want)))
      << got.x << ' ' << got.y << ' ' << got.z << ", expected " << want.x << ' ' << want.y << ' ' << want.z;
}

Camera camera(const std::string& members) { return scene_of_members("\"cameras\": [{" + members + "}]").cameras.at(0); }
Light light(const std::string& members) { return scene_of_members("\"lights\": [{" + members + "}]").lights.at(0); }
template <class Shape>
Shape shape(const std::string& members) {
  return std::get<Shape>(light(members).shape);
}
glm::mat4 placed(const std::string& members) {
  return scene_of_members("\"meshes\": {\"b\": {\"shape\": \"box\"}}, \"instances\": [{\"mesh\": \"b\", " + members +
                          "}]")
      .instances.at(0)
      .world_from_object;
}
Material material(const std::string& members) {
  return scene_of_members(
             "\"meshes\": {\"b\": {\"shape\": \"sphere\"}}, \"instances\": [{\"mesh\": \"b\", \"material\": \"m\"}], "
             "\"materials\": {\"m\": {" +
             members + "}}")
      .materials.at(0);
}

TEST(SceneEntries, ASceneThatUsesEverySectionIsSound) {
  const Scene scene = scene_of_text(small_scene());
  EXPECT_EQ(fault_of(scene), "");
  EXPECT_EQ(scene.name, "small");
  EXPECT_EQ(scene.instances.size(), 6u);  // the OBJ has two materials
  EXPECT_EQ(scene.lights.size(), 6u);
  EXPECT_EQ(scene.profiles.size(), 1u);
  EXPECT_EQ(scene.view.ev, 1);
  EXPECT_EQ(scene.view.name, "gt");
}

TEST(SceneEntries, ACommentIsIgnoredEverywhere) {
  const Scene scene = scene_of_members(
      "\"comment\": 1, \"cameras\": [{\"comment\": [2]}], \"meshes\": {\"comment\": \"text\", \"b\": {\"shape\": "
      "\"sphere\", "
      "\"comment\": null}}, \"materials\": {\"comment\": {}, \"m\": {\"parameters\": {\"comment\": \"x\"}}}, "
      "\"instances\": [{\"mesh\": \"b\", \"material\": \"m\", \"comment\": {}}], \"view\": {\"comment\": 1}");
  EXPECT_EQ(scene.instances.size(), 1u);
}

TEST(SceneEntries, DefaultsAreThoseOfThePlainValues) {
  const Camera camera = test::camera("");
  EXPECT_EQ(camera.width, Camera{}.width);
  EXPECT_EQ(camera.height, Camera{}.height);
  EXPECT_EQ(camera.world_from_camera, glm::mat4(1));
  EXPECT_EQ(camera.lens_radius, 0);
  EXPECT_EQ(camera.focus_distance, 1);
  EXPECT_EQ(placed("\"name\": \"x\""), glm::mat4(1));
  const Material m = material("");
  EXPECT_EQ(m.opacity_cutoff, Material{}.opacity_cutoff);
  EXPECT_EQ(m.normal_strength, Material{}.normal_strength);
  EXPECT_EQ(m.two_sided, Material{}.two_sided);
  EXPECT_EQ(m.emission, glm::vec3(0));
  const Light point = light("\"type\": \"point\"");
  EXPECT_EQ(point.range, kForever);
  EXPECT_EQ(point.profile, kNone);
  EXPECT_EQ(point.profile_axis, Light{}.profile_axis);
  EXPECT_FALSE(point.is_movable);
  EXPECT_TRUE(point.is_visible);
  EXPECT_EQ(shape<DiskLight>("\"type\": \"disk\"").radius, DiskLight{}.radius);
  EXPECT_EQ(shape<DiskLight>("\"type\": \"disk\"").normal, DiskLight{}.normal);
  EXPECT_EQ(shape<SphereLight>("\"type\": \"sphere\"").radius, SphereLight{}.radius);
  const auto rectangle = shape<RectangleLight>("\"type\": \"rectangle\"");
  expect_near(glm::cross(rectangle.half_u, rectangle.half_v), {0, -0.25, 0});  // 1 m x 1 m, downwards
  EXPECT_EQ(scene_of_members("\"name\": \"\"").view.name, View{}.name);
  EXPECT_FALSE(scene_of_members("\"name\": \"\"").environment);
}

TEST(SceneEntries, AnOrthographicCameraSpansItsHeight) {
  const Camera c = camera("\"width\": 200, \"height\": 100, \"orthographic_height\": 0.5");
  EXPECT_TRUE(c.is_orthographic);
  EXPECT_EQ(c.focal_x, 200);  // pixels a metre
  EXPECT_EQ(c.focal_y, 200);
  EXPECT_FALSE(camera("\"width\": 200").is_orthographic);
}

TEST(SceneEntries, ACameraLooksAtItsTarget) {
  const Camera c =
      camera("\"position\": [1, 2, 3], \"target\": [4, 2, 3], \"width\": 200, \"height\": 100, \"fov_deg\": 90");
  expect_near(glm::vec3(c.world_from_camera * glm::vec4(0, 0, -1, 0)), {1, 0, 0});
  expect_near(glm::vec3(c.world_from_camera * glm::vec4(0, 1, 0, 0)), {0, 1, 0});
  expect_near(glm::vec3(c.world_from_camera * glm::vec4(1, 0, 0, 0)), {0, 0, 1});
  expect_near(glm::vec3(c.world_from_camera[3]), {1, 2, 3});
  EXPECT_NEAR(c.focal_y, 50, 1e-9);  // half the height over tan 45 degrees
  EXPECT_EQ(c.focal_x, c.focal_y);
  EXPECT_EQ(c.center_x, 100);
  EXPECT_EQ(c.center_y, 50);
  EXPECT_FLOAT_EQ(c.focus_distance, 3);
}

TEST(SceneEntries, ACameraThatLooksAlongItsUpHasMinusZUpwards) {
  const Camera c = camera("\"position\": [0, 5, 0], \"target\": [0, 0, 0]");
  expect_near(glm::vec3(c.world_from_camera[1]), {0, 0, -1});
  const Camera along = camera("\"target\": [1, 0, 0], \"up\": [1, 0, 0]");
  expect_near(glm::vec3(along.world_from_camera[1]), {0, 0, -1});
  expect_near(glm::vec3(along.world_from_camera[2]), {-1, 0, 0});
}

TEST(SceneEntries, ALensIsStatedInMillimetersOrMeters) {
  const Camera c = camera("\"focal_mm\": 50, \"f_number\": 2, \"height\": 240, \"focus_distance\": 2.5");
  EXPECT_NEAR(c.focal_y, 500, 1e-9);  // 50 mm over a sensor 24 mm high
  EXPECT_FLOAT_EQ(c.lens_radius, 0.0125f);
  EXPECT_FLOAT_EQ(c.focus_distance, 2.5f);
  EXPECT_FLOAT_EQ(camera("\"aperture_radius\": 0.1").lens_radius, 0.1f);
  EXPECT_NEAR(camera("\"focal_mm\": 50, \"sensor_mm\": 36, \"height\": 360").focal_y, 500, 1e-9);
}

TEST(SceneEntries, ACalibratedCameraIsTakenAsItIs) {
  const Camera c = camera(
      "\"matrix\": [[0, 0, 1, 5], [0, 1, 0, 6], [-1, 0, 0, 7]], \"focal_px\": [700, 710], \"center_px\": [250.5, 260]");
  expect_near(glm::vec3(c.world_from_camera[0]), {0, 0, -1});
  expect_near(glm::vec3(c.world_from_camera[2]), {1, 0, 0});
  expect_near(glm::vec3(c.world_from_camera[3]), {5, 6, 7});
  EXPECT_EQ(c.focal_x, 700);
  EXPECT_EQ(c.focal_y, 710);
  EXPECT_EQ(c.center_x, 250.5);
  EXPECT_EQ(c.center_y, 260);
}

TEST(SceneEntries, AnInstanceIsScaledTurnedAboutXThenYThenZAndMoved) {
  const glm::mat4 m = placed("\"scale\": 2, \"rotate_deg\": [90, 90, 0], \"translate\": [10, 0, 0]");
  // y: about x to z, about y to x, doubled.
  expect_near(glm::vec3(m * glm::vec4(0, 1, 0, 1)), {12, 0, 0});
  expect_near(glm::vec3(placed("\"rotate_deg\": [0, 0, 90]") * glm::vec4(1, 0, 0, 1)), {0, 1, 0});
  expect_near(
      glm::vec3(placed("\"matrix\": [[1, 2, 0, 5], [0, 1, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]") * glm::vec4(0, 1, 0, 1)),
      {7, 7, 7});
}

TEST(SceneEntries, APointLightsPowerIsSpreadOverTheSphere) {
  expect_near(shape<PointLight>("\"type\": \"point\", \"strength\": 3, \"color\": [1, 0.5, 0]").intensity,
              {3, 1.5f, 0});
  expect_near(shape<PointLight>("\"type\": \"point\", \"strength\": 100, \"unit\": \"W\"").intensity,
              glm::dvec3(100 / (4 * std::numbers::pi)));
  expect_near(shape<PointLight>("\"type\": \"point\", \"strength\": 683, \"unit\": \"lm\"").intensity,
              glm::dvec3(1 / (4 * std::numbers::pi)));
  expect_near(shape<PointLight>("\"type\": \"point\", \"strength\": 683, \"unit\": \"cd\"").intensity, glm::vec3(1));
}

TEST(SceneEntries, ASpotsPowerIsThatOfItsCone) {
  const auto spot =
      shape<SpotLight>("\"type\": \"spot\", \"strength\": 10, \"unit\": \"W\", \"inner_deg\": 20, \"outer_deg\": 50");
  // The same by the midpoint rule over the cosine, with the falloff as scene.h states it.
  double integral = 0;
  const double inner = std::cos(20 * std::numbers::pi / 180), outer = std::cos(50 * std::numbers::pi / 180);
  for (int i = 0; i < 100'000; ++i) {
    const double c = outer + (1 - outer) * (i + 0.5) / 100'000, t = std::min((c - outer) / (inner - outer), 1.0);
    integral += 2 * std::numbers::pi * t * t * (3 - 2 * t) * (1 - outer) / 100'000;
  }
  EXPECT_NEAR(spot.intensity.x * integral, 10, 1e-5);  // float, and 1e-9 of the rule
  EXPECT_FLOAT_EQ(spot.inner, static_cast<float>(20 * std::numbers::pi / 180));
  EXPECT_FLOAT_EQ(spot.outer, static_cast<float>(50 * std::numbers::pi / 180));
  expect_near(shape<SpotLight>("\"type\": \"spot\", \"position\": [0, 1, 0], \"target\": [0, 1, 5]").direction,
              {0, 0, 1});
}

TEST(SceneEntries, AnAreaLightsPowerIsLambertian) {
  const auto one =
      shape<RectangleLight>("\"type\": \"rectangle\", \"size\": [2, 3], \"strength\": 12, \"unit\": \"W\"");
  expect_near(one.radiance, glm::dvec3(12 / (std::numbers::pi * 6)));
  const auto two = shape<RectangleLight>(
      "\"type\": \"rectangle\", \"size\": [2, 3], \"strength\": 12, \"unit\": \"W\", \"two_sided\": true");
  expect_near(two.radiance, glm::dvec3(6 / (std::numbers::pi * 6)));
  EXPECT_TRUE(two.two_sided);
  expect_near(shape<DiskLight>("\"type\": \"disk\", \"radius\": 2, \"strength\": 683, \"unit\": \"lm\"").radiance,
              glm::dvec3(1 / (std::numbers::pi * 4 * std::numbers::pi)));
  expect_near(shape<SphereLight>("\"type\": \"sphere\", \"radius\": 2, \"strength\": 5, \"unit\": \"W\"").radiance,
              glm::dvec3(5 / (4 * std::numbers::pi * std::numbers::pi * 4)));
  expect_near(shape<SphereLight>("\"type\": \"sphere\", \"strength\": 1366, \"unit\": \"cd/m2\"").radiance,
              glm::vec3(2));
  expect_near(shape<DirectionalLight>("\"type\": \"directional\", \"strength\": 683, \"unit\": \"lx\"").irradiance,
              glm::vec3(1));
}

TEST(SceneEntries, ARectangleShinesAlongItsDirection) {
  const auto one = shape<RectangleLight>(
      "\"type\": \"rectangle\", \"position\": [0, 0, 5], \"target\": [0, 0, 0], \"size\": [4, 2]");
  expect_near(glm::normalize(glm::cross(one.half_u, one.half_v)), {0, 0, -1});
  EXPECT_NEAR(glm::length(one.half_u), 2, 1e-6);
  expect_near(one.half_v, {0, 1, 0});
  const auto two = shape<RectangleLight>("\"type\": \"rectangle\", \"half_u\": [0, 0, 3], \"half_v\": [2, 0, 0]");
  expect_near(two.half_u, {0, 0, 3});
  expect_near(two.half_v, {2, 0, 0});
}

TEST(SceneEntries, ALightKeepsItsFlagsAndRange) {
  const Light one =
      light("\"type\": \"sphere\", \"name\": \"bulb\", \"movable\": true, \"visible\": false, \"range\": 7");
  EXPECT_EQ(one.name, "bulb");
  EXPECT_TRUE(one.is_movable);
  EXPECT_FALSE(one.is_visible);
  EXPECT_EQ(one.range, 7);
}

TEST(SceneEntries, AProfileIsReadOnceAndScalesTheLight) {
  const Scene scene = scene_of_members(
      "\"lights\": [{\"type\": \"point\", \"profile\": \"lamp.ies\", \"unit\": \"lm\", \"strength\": 683}, {\"type\": "
      "\"point\", \"profile\": "
      "\"lamp.ies\", \"unit\": \"profile\", \"strength\": 2, \"profile_axis\": [0, 0, -1], \"profile_zero\": [1, 0, "
      "1]}]");
  ASSERT_EQ(scene.profiles.size(), 1u);
  EXPECT_NEAR(std::get<PointLight>(scene.lights[0].shape).intensity.x * solid_angle(scene.profiles[0]), 1, 1e-6);
  EXPECT_NEAR(std::get<PointLight>(scene.lights[1].shape).intensity.x, 2 * 120 / 683.0, 1e-6);  // peak 120 cd
  expect_near(scene.lights[1].profile_axis, {0, 0, -1});
  expect_near(scene.lights[1].profile_zero, {1, 0, 0});
}

TEST(SceneEntries, AMaterialIsAFileOrAModelWithParametersAndTextures) {
  const Material file = material("\"file\": \"gold.material.json\", \"parameters\": {\"roughness\": 0.5}");
  const auto& ggx = std::get<brdf::Ggx<double>>(file.brdf);
  EXPECT_EQ(ggx.f0.g, 0.7);
  EXPECT_EQ(ggx.roughness, 0.5);
  const Material inlined = material(
      "\"parameters\": {\"metallic\": 0.25, \"base_color\": 0.125, \"roughness\": {\"file\": \"rgb.png\", \"channel\": "
      "\"b\", "
      "\"scale\": -1, \"offset\": 1, \"wrap\": \"clamp\", \"uv_scale\": [2, 3], \"uv_offset\": [0.5, 0.25]}}");
  const auto& callisto = std::get<brdf::Callisto<double>>(inlined.brdf);
  EXPECT_EQ(callisto.metallic, 0.25);
  EXPECT_EQ(callisto.base_color.b, 0.125);
  ASSERT_EQ(inlined.bindings.size(), 1u);
  EXPECT_EQ(brdf::Callisto<double>::kParameters[inlined.bindings[0].parameter].name, "roughness");
  const Texture& t = inlined.bindings[0].texture;
  EXPECT_EQ(t.channel, 2);
  EXPECT_EQ(t.transfer, Transfer::kLinear);
  EXPECT_EQ(t.wrap, Wrap::kClamp);
  EXPECT_EQ(t.scale, glm::vec3(-1));
  EXPECT_EQ(t.offset, glm::vec3(1));
  EXPECT_EQ(t.uv_scale, glm::vec2(2, 3));
  EXPECT_EQ(t.uv_offset, glm::vec2(0.5f, 0.25f));
}

TEST(SceneEntries, ColorsAreSrgbAndNumbersAndNormalsLinearUnlessTheFileSaysOtherwise) {
  const Material m = material(
      "\"parameters\": {\"base_color\": {\"file\": \"rgb.png\"}, \"metallic\": {\"file\": \"grey.png\", \"transfer\": "
      "\"srgb\"}}, "
      "\"normal_map\": {\"file\": \"rgb.png\"}, \"normal_strength\": 0.5, \"diffuse_normal_map\": {\"file\": "
      "\"rgb.png\"}, "
      "\"opacity\": {\"file\": \"paint.png\", \"channel\": \"a\"}, \"opacity_cutoff\": 0.75, \"emission\": [683, 0, "
      "683], "
      "\"emission_unit\": \"cd/m2\", \"emission_map\": {\"file\": \"rgb.png\"}, \"two_sided\": false");
  EXPECT_EQ(m.bindings.at(0).texture.transfer, Transfer::kSrgb);
  EXPECT_EQ(m.bindings.at(1).texture.transfer, Transfer::kSrgb);
  EXPECT_EQ(m.normal_map->transfer, Transfer::kLinear);
  EXPECT_EQ(m.normal_strength, 0.5f);
  EXPECT_EQ(m.diffuse_normal_map->transfer, Transfer::kLinear);
  EXPECT_EQ(m.opacity->channel, 3);
  EXPECT_EQ(m.opacity_cutoff, 0.75f);
  expect_near(m.emission, {1, 0, 1});
  EXPECT_EQ(m.emission_map->transfer, Transfer::kSrgb);
  EXPECT_FALSE(m.two_sided);
}

TEST(SceneEntries, APictureIsReadOnceHoweverManyUseIt) {
  int count = 0;
  const Files files = small_files();
  Access access = access_of(files);
  access.texels = [&](const std::filesystem::path& file) { return ++count, small_texels(file.string()); };
  const Scene scene = scene_of(
      scene_with("\"meshes\": {\"b\": {\"shape\": \"sphere\"}}, \"instances\": [{\"mesh\": \"b\", \"material\": "
                 "\"m\"}], \"materials\": {\"m\": {\"parameters\": {\"roughness\": {\"file\": \"rgb.png\"}, "
                 "\"metallic\": {\"file\": \"./rgb.png\", \"channel\": \"b\"}}}}"),
      "room.json", "", access);
  EXPECT_EQ(count, 1);
  EXPECT_EQ(scene.images.size(), 1u);
}

TEST(SceneEntries, TexelsThatAreNoLightAreMadeAndCounted) {
  const Scene scene =
      scene_of_members("\"environment\": {\"file\": \"light.hdr\", \"scale\": [1, 2, 3], \"turn_deg\": 450}");
  EXPECT_EQ(count_of(scene, "texels that are no numbers"), 1u);
  EXPECT_EQ(count_of(scene, "texels without bound"), 1u);
  EXPECT_EQ(count_of(scene, "negative texels"), 1u);
  EXPECT_EQ(scene.images[0].texels.floats[0], 0);
  EXPECT_EQ(scene.images[0].texels.floats[1], 65504);
  EXPECT_EQ(scene.images[0].texels.floats[2], 0);
  expect_near(scene.environment->scale, {1, 2, 3});
  EXPECT_NEAR(scene.environment->turn, std::numbers::pi / 2, 1e-6);  // 450 degrees
  expect_near(scene_of_members("\"environment\": {\"radiance\": 683, \"unit\": \"cd/m2\"}").environment->scale,
              glm::vec3(1));
}

TEST(SceneEntries, ASceneWithoutCameraGetsOneThatSeesEverything) {
  const Scene scene = scene_of_members(
      "\"meshes\": {\"b\": {\"shape\": \"box\"}}, \"instances\": [{\"mesh\": \"b\", \"translate\": [5, 0, 0]}, "
      "{\"mesh\": \"b\", \"translate\": [-5, 3, -8]}]");
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(count_of(scene, "no camera"), 1u);
  EXPECT_EQ(count_of(scene, "no light"), 1u);
  const Camera& c = scene.cameras[0];
  const glm::mat4 camera_from_world = glm::inverse(c.world_from_camera);
  for (const Instance& instance : scene.instances)
    for (const glm::vec3& p : scene.meshes[instance.mesh].positions) {
      const glm::vec4 at = camera_from_world * instance.world_from_object * glm::vec4(p, 1);
      ASSERT_LT(at.z, 0);
      EXPECT_LT(std::abs(at.x / at.z) * c.focal_x, 256);
      EXPECT_LT(std::abs(at.y / at.z) * c.focal_y, 256);
    }
}

TEST(SceneEntries, WhatNothingUsesIsLeftOutAndTheRestFollows) {
  const Scene scene = scene_of_members(
      "\"meshes\": {\"g\": {\"file\": \"square.glb\"}, \"x\": {\"file\": \"none.glb\"}}, \"materials\": {\"m\": "
      "{\"parameters\": "
      "{\"metallic\": {\"file\": \"grey.png\"}}, \"normal_map\": {\"file\": \"rgb.png\"}}, \"y\": {\"file\": "
      "\"none\"}}, "
      "\"instances\": [{\"mesh\": \"g\", \"material\": \"m\"}], \"environment\": {\"file\": \"light.hdr\"}");
  EXPECT_EQ(fault_of(scene), "");
  ASSERT_EQ(scene.materials.size(), 1u);  // the glTF's own and its picture are not used
  EXPECT_EQ(scene.materials[0].name, "m");
  ASSERT_EQ(scene.images.size(), 3u);
  EXPECT_EQ(scene.images[scene.materials[0].bindings.at(0).texture.image].name, "grey.png");
  EXPECT_EQ(scene.images[scene.materials[0].normal_map->image].name, "rgb.png");
  EXPECT_EQ(scene.images[scene.environment->image].name, "light.hdr");
}

}  // namespace
}  // namespace likeness::scene::test
