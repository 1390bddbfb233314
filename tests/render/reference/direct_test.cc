#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/render/reference/small_scenes.h"

// Direct light against closed forms, and what lights are to the camera and to each other.
namespace likeness::reference {
namespace {

// A white Lambert floor (albedo 1/2), looked at from straight above, aside of the light; the pixel is a point.
scene::Scene floor_with(const scene::LightShape& shape) {
  scene::Scene scene;
  scene.meshes = {square_mesh()};
  scene.materials = {material_of(lambert(0.5))};
  scene.instances = {{"", 0, 0, placed({0, 0, 0}, 50)}};
  scene.lights = {{"", shape}};
  scene.cameras = {camera_at({0, 1, 0}, {0, 0, 0}, 2, 2, 1e5)};
  return scene;
}

void expect_irradiance(const char* what, const scene::Scene& scene, double exact) {
  const Estimate e = estimate(scene, {.samples = 256, .max_bounces = 1});
  // 4.5 standard errors of a dozen seeds, and the floats of a density.
  EXPECT_NEAR(e.mean, 0.5 / std::numbers::pi * exact, 4.5 * e.error + 3e-4 * exact) << what;
  EXPECT_LT(e.error, 0.02 * exact + 1e-12) << what;
}

TEST(DirectLight, IsThatOfTheFormFactor) {
  // A square of half side a at height h over the point: four times that of its quarter (parallel plates).
  const double a = 0.5, h = 2, x = a / h, root = std::sqrt(1 + x * x);
  const double square = 4 * (x / root) * std::atan(x / root);  // pi F = E of radiance 1: 2 (..) twice, for both sides
  expect_irradiance("square", floor_with(scene::RectangleLight{{0, 2, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}, {1, 1, 1}}),
                    square);
  expect_irradiance("disk", floor_with(scene::DiskLight{{0, 2, 0}, {0, -1, 0}, 0.5f, {1, 1, 1}}),
                    std::numbers::pi * 0.25 / 4.25);
  expect_irradiance("sphere", floor_with(scene::SphereLight{{0, 2, 0}, 0.5f, {1, 1, 1}}), std::numbers::pi * 0.25 / 4);
  expect_irradiance("sphere aside", floor_with(scene::SphereLight{{3, 4, 0}, 0.5f, {1, 1, 1}}),
                    std::numbers::pi * 0.25 / 25 * 0.8);
  expect_irradiance("large sphere near", floor_with(scene::SphereLight{{0, 2, 0}, 1.9f, {1, 1, 1}}),
                    std::numbers::pi * 3.61 / 4);
  expect_irradiance("point", floor_with(scene::PointLight{{0, 2, 0}, {1, 1, 1}}), 0.25);
  expect_irradiance("direction", floor_with(scene::DirectionalLight{{0.6f, -0.8f, 0}, {1, 1, 1}}), 0.8);
  expect_irradiance("from behind", floor_with(scene::DiskLight{{0, 2, 0}, {0, 1, 0}, 0.5f, {1, 1, 1}}), 0);
  auto far = floor_with(scene::DiskLight{{0, 10000, 0}, {0, -1, 0}, 50, {1, 1, 1}});
  expect_irradiance("10 km away", far, std::numbers::pi * 2500 / (1e8 + 2500));
  far.lights[0].is_visible = false;
  expect_irradiance("that paths do not meet", far, std::numbers::pi * 2500 / (1e8 + 2500));
}

TEST(DirectLight, OfAnEmissiveSquareIsThatOfTheFormFactorOnTheSideItShinesTo) {
  auto scene = floor_with(scene::PointLight{{0, 2, 0}, {0, 0, 0}});
  scene.materials.push_back(material_of(lambert(0)));
  scene.materials[1].emission = {1, 1, 1};
  scene.meshes.push_back(box_mesh());
  // Over the point hangs a box, whose lower side is the square.
  scene.instances.push_back({"", 1, 1, placed({0, 2.5f, 0}, 0.5f)});
  scene.cameras = {camera_at({0.6f, 0.4f, 0.5f}, {0, 0, 0}, 2, 2, 1e5)};
  const double x = 0.25, root = std::sqrt(1 + x * x), exact = 4 * (x / root) * std::atan(x / root);
  expect_irradiance("two sides", scene, exact);
  scene.materials[1].two_sided = false;
  expect_irradiance("out", scene, exact);
  for (auto& t : scene.meshes[1].triangles) std::swap(t[1], t[2]);
  // In: a floor that is reached by nothing but edges, where an offset of 1e-5 m may start inside.
  EXPECT_LT(rendered(scene, {.samples = 256, .max_bounces = 1}).mean.g, 1e-3 * exact);
}

TEST(DirectLight, ThatIsHiddenIsNone) {
  for (const scene::LightShape& shape : std::initializer_list<scene::LightShape>{
           scene::PointLight{{0, 2, 0}, {1, 1, 1}}, scene::DirectionalLight{{0, -1, 0}, {1, 1, 1}},
           scene::SphereLight{{0, 2, 0}, 0.5f, {1, 1, 1}}}) {
    auto scene = floor_with(shape);
    scene.instances.push_back({"lid", 0, 0, placed({0, 1.2f, 0}, 40)});
    EXPECT_EQ(rendered(scene, {.samples = 16, .max_bounces = 1}).mean.g, 0);
    // Lit from under its other side, the floor is not.
    scene.instances.pop_back();
    scene.cameras = {camera_at({0, -1, 0}, {0, 0, 0}, 2, 2, 100)};
    EXPECT_EQ(rendered(scene, {.samples = 16, .max_bounces = 1}).mean.g, 0);
  }
}

// A ray goes on behind a light: it adds to what is there, whatever the camera and the order.
TEST(Lights, ThatTheCameraSeesAddToWhatIsBehindThem) {
  scene::Scene scene;
  scene.environment = scene::Environment{scene::kNone, {0.25f, 0.25f, 0.25f}, 0};
  scene.lights = {{"", scene::DiskLight{{0, 0, -2}, {0, 0, 1}, 9, {1, 1, 1}}},
                  {"", scene::RectangleLight{{0, 0, -1}, {9, 0, 0}, {0, 9, 0}, {2, 2, 2}}},
                  {"", scene::DiskLight{{0, 0, -3}, {0, 0, -1}, 9, {4, 4, 4}}},        // its back
                  {"", scene::DiskLight{{0, 0, -4}, {0, 0, -1}, 9, {8, 8, 8}, true}},  // of two sides
                  {"", scene::DiskLight{{0, 0, -5}, {0, 0, 1}, 9, {16, 16, 16}}}};     // not visible
  scene.lights[4].is_visible = false;
  scene.cameras = {camera_at({0, 0, 0}, {0, 0, -1}, 4, 4)};
  for (const float x : rendered(scene, {.samples = 4}).picture.rgb) ASSERT_FLOAT_EQ(x, 1 + 2 + 8 + 0.25f);
}

TEST(Lights, EmissionIsSeenFromTheSidesItHas) {
  scene::Scene scene;
  scene.meshes = {square_mesh()};
  scene.materials = {material_of(lambert(0))};
  scene.materials[0].emission = {3, 2, 1};
  scene.instances = {{"", 0, 0, placed({0, 0, 0}, 50)}};
  for (const bool two_sided : {true, false})
    for (const float side : {1.0f, -1.0f}) {
      scene.materials[0].two_sided = two_sided;
      scene.cameras = {camera_at({0, side, 0}, {0, 0, 0}, 2, 2)};
      const double expected = two_sided || side > 0 ? 2 : 0;
      EXPECT_EQ(rendered(scene, {.samples = 2}).mean.g, expected) << side;
    }
}

TEST(MaxBounces, CountsThoseOfTheLight) {
  // A floor lit by a point light over it; a lid above the light, so that two bounces bring more.
  auto scene = floor_with(scene::PointLight{{0, 2, 0}, {1, 1, 1}});
  scene.instances.push_back({"lid", 0, 0, placed({0, 4, 0}, 50)});
  const double none = rendered(scene, {.samples = 256, .max_bounces = 0}).mean.g;
  const double one = rendered(scene, {.samples = 256, .max_bounces = 1}).mean.g;
  const double two = rendered(scene, {.samples = 256, .max_bounces = 2}).mean.g;
  EXPECT_EQ(none, 0);
  EXPECT_NEAR(one, 0.5 / std::numbers::pi / 4, 1e-5);
  EXPECT_GT(two, 1.05 * one);
}

// Panels are often flush with the ceiling that they are in: paths must not slip past it into the open.
TEST(Lights, FlushWithACeilingLetNoRayThroughIt) {
  auto scene = floor_with(scene::RectangleLight{{0, 2, 0}, {1, 0, 0}, {0, 0, 1}, {1, 1, 1}});
  scene.materials[0] = material_of(lambert(0));
  scene.instances = {{"ceiling", 0, 0, placed({0, 2, 0}, 50)}};
  scene.environment = scene::Environment{scene::kNone, {1000, 1000, 1000}, 0};
  scene.cameras = {camera_at({0.3f, 0, 0.2f}, {0, 2, 0.1f}, 8, 8)};
  for (const float x : rendered(scene, {.samples = 16}).picture.rgb) ASSERT_LT(x, 1.1f);
  // From far below, where a part of the distance is more than what parts the two.
  scene.cameras = {camera_at({0.3f, -300, 0.2f}, {0, 2, 0.1f}, 8, 8, 100)};
  for (const float x : rendered(scene, {.samples = 16}).picture.rgb) ASSERT_LT(x, 1.1f);
}

TEST(Lights, BehindAWallAreNotSeenThroughALightBeforeIt) {
  auto scene = floor_with(scene::DiskLight{{0, 1, 0}, {0, -1, 0}, 1, {1, 1, 1}});
  scene.lights.push_back({"", scene::DiskLight{{0, 3, 0}, {0, -1, 0}, 1, {1000, 1000, 1000}}});
  scene.materials[0] = material_of(lambert(0));
  scene.instances = {{"wall", 0, 0, placed({0, 2, 0}, 50)}};
  scene.cameras = {camera_at({0.1f, 0, 0}, {0, 2, 0}, 4, 4, 10)};
  for (const float x : rendered(scene, {.samples = 4}).picture.rgb) ASSERT_FLOAT_EQ(x, 1);
}

}  // namespace
}  // namespace likeness::reference
