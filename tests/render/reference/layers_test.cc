#include <cmath>

#include <gtest/gtest.h>

#include "tests/render/reference/small_scenes.h"

namespace likeness::reference {
namespace {

// A floor, a ball of all parts of Callisto, a glowing ball, two lights and a sky with a picture.
scene::Scene layered_stage() {
  scene::Scene scene;
  scene.meshes = {square_mesh(), sphere_mesh(), box_mesh()};
  brdf::Callisto<double> callisto;
  callisto.roughness = 0.4, callisto.diffuse_fresnel = 3, callisto.smooth_terminator = 0.5, callisto.metallic = 0.2;
  callisto.dual_specular_opacity = 0.3;
  scene.materials = {material_of(lambert(0.6)), material_of(callisto), material_of(lambert(0.2))};
  scene.materials[2].emission = {1, 2, 3};
  scene.instances = {
      {"", 0, 0, placed({0, -1, 0}, 5)}, {"", 1, 1, placed({-1, 0, 0})}, {"", 2, 2, placed({1, 0, 0}, 0.5f)}};
  scene.lights = {{"ball", scene::SphereLight{{0, 1.5f, 1}, 0.3f, {20, 10, 5}}},
                  {"sun", scene::DirectionalLight{glm::normalize(glm::vec3(1, -1, -1)), {1, 1, 1}}}};
  scene.images = {{"", {4, 2, 3, {}, {}}}};
  for (int i = 0; i < 24; ++i) scene.images[0].texels.floats.push_back(0.1f * static_cast<float>(i % 7));
  scene.environment = scene::Environment{0, {1, 1, 1}, 0};
  scene.cameras = {camera_at({0, 0.5f, 5}, {0, 0, 0}, 32, 32, 1)};
  return scene;
}

TEST(Layers, OfLightAddUpToThePicture) {
  const auto r = rendered(layered_stage(), {.samples = 32, .has_layers = true});
  const image::Layers layers = r.film.layers();
  const auto& emitted = layers.find("emitted")->data;
  const auto& direct = layers.find("direct")->data;
  const auto& indirect = layers.find("indirect")->data;
  const auto& diffuse = layers.find("diffuse")->data;
  const auto& specular = layers.find("specular")->data;
  double sums[5]{};
  for (std::size_t i = 0; i < emitted.size(); ++i) {
    const float whole = r.picture.rgb[i];
    ASSERT_NEAR(emitted[i] + direct[i] + indirect[i], whole, 1e-5f * (1 + whole)) << i;  // means in float
    ASSERT_NEAR(diffuse[i] + specular[i], direct[i] + indirect[i], 1e-5f * (1 + whole)) << i;
    for (const float x : {emitted[i], direct[i], indirect[i], diffuse[i], specular[i]}) ASSERT_GE(x, -1e-6f);
    sums[0] += emitted[i], sums[1] += direct[i], sums[2] += indirect[i], sums[3] += diffuse[i], sums[4] += specular[i];
  }
  for (const double sum : sums) EXPECT_GT(sum, 1);  // none of them is idle
  // The layers do not change the picture.
  EXPECT_EQ(r.picture.rgb, rendered(layered_stage(), {.samples = 32}).picture.rgb);
}

TEST(Layers, OfGeometryAreThoseOfTheFirstSurface) {
  scene::Scene scene;
  scene.meshes = {square_mesh()};
  scene.materials = {material_of(lambert(0.3))};
  scene.instances = {{"", 0, 0, placed({0, 0, 0}, 4)}};
  scene.lights = {{"", scene::DiskLight{{0, 2, 0}, {0, 1, 0}, 3, {1, 1, 1}}}};  // seen through
  scene.cameras = {camera_at({1, 4, 2}, {1, 0, 2}, 1, 1, 1e4)};
  const image::Layers layers = rendered(scene, {.samples = 4, .has_layers = true}).film.layers();
  const auto at = [&](const char* name, std::size_t k) { return layers.find(name)->data[k]; };
  EXPECT_NEAR(at("depth", 0), 4, 1e-3);
  EXPECT_NEAR(at("position", 0), 1, 1e-3);
  EXPECT_NEAR(at("position", 2), 2, 1e-3);
  EXPECT_NEAR(at("normal", 1), 1, 1e-6);
  EXPECT_NEAR(at("shading_normal", 1), 1, 1e-6);
  EXPECT_NEAR(at("uv", 0), 0.625, 1e-4);
  EXPECT_NEAR(at("uv", 1), 0.75, 1e-4);
  EXPECT_NEAR(at("base_color", 1), 0.3, 1e-6);
  EXPECT_NEAR(at("emitted", 1), 1, 1e-6);
}

// What a light would send to the camera if nothing hid it, and how much of it is not hidden: their product is the
// direct light of one light without a size.
TEST(LightLayers, AreVisibilityAndLightOfEachLight) {
  scene::Scene scene;
  scene.meshes = {square_mesh()};
  scene.materials = {material_of(lambert(0.5))};
  scene.instances = {{"floor", 0, 0, placed({0, 0, 0}, 10)}, {"lid", 0, 0, placed({0, 1, 0}, 1)}};
  scene.lights = {{"over", scene::PointLight{{0, 2, 0}, {1, 2, 3}}},
                  {"side", scene::PointLight{{50, 0.5f, 0}, {1, 1, 1}}},
                  {"", scene::SphereLight{{0, 8, 0}, 1, {1, 1, 1}}},
                  {"pane", scene::DiskLight{{0.2f, 0.5f, 0}, {1, 0, 0}, 0.4f, {1, 1, 1}}}};
  // Under the lid, from aside; the pane is in the way of the camera and hides nothing.
  scene.cameras = {camera_at({3, 0.5f, 0}, {0, 0, 0}, 1, 1, 1e4)};
  const world::World world(scene, plan::plan_of(scene));
  image::Layers layers{1, 1, {}, {}};
  add_light_layers(world, {.samples = 16}, layers);
  ASSERT_EQ(layers.layers.size(), 8u);
  const auto of = [&](const char* name) { return layers.find(name)->data[0]; };
  EXPECT_EQ(of("visibility.over"), 0);
  EXPECT_NEAR(of("light.over"), 0.5 / 3.14159 / 4, 1e-4);
  EXPECT_EQ(of("visibility.side"), 1);
  EXPECT_NEAR(of("light.side"), 0.5 / 3.14159 * 0.01 / 2500, 1e-8);
  EXPECT_EQ(of("visibility.2"), 0);
  EXPECT_GT(of("light.2"), 0);
  EXPECT_EQ(layers.find("light.over")->channels.size(), 3u);
}

TEST(LightLayers, OfLightsWithOneNameAreToldApart) {
  scene::Scene scene;
  scene.lights = {{"a", scene::PointLight{}},
                  {"a", scene::PointLight{}},
                  {"1", scene::PointLight{}},
                  {"", scene::PointLight{}},
                  {"3", scene::PointLight{}}};
  scene.cameras = {camera_at({0, 0, 5}, {0, 0, 0}, 2, 2)};
  const world::World world(scene, plan::plan_of(scene));
  image::Layers layers{2, 2, {}, {}};
  add_light_layers(world, {.samples = 1}, layers);
  for (std::size_t i = 0; i < layers.layers.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(layers.layers[i].name, layers.layers[k].name);
}

}  // namespace
}  // namespace likeness::reference
