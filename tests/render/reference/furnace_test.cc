#include <cmath>

#include <gtest/gtest.h>

#include "tests/render/reference/small_scenes.h"

// Scenes whose light is known without a sample.
namespace likeness::reference {
namespace {

scene::Scene in_furnace(const scene::Material& material, const scene::Mesh& mesh) {
  scene::Scene scene;
  scene.meshes = {mesh};
  scene.materials = {material};
  scene.instances = {{"", 0, 0, glm::mat4(1)}};
  scene.environment = scene::Environment{scene::kNone, {1, 1, 1}, 0};
  scene.cameras = {camera_at({0, 0.3f, 5}, {0, 0, 0}, 12, 12, 2)};
  return scene;
}

// Every path of a white surface brings exactly 1: weights of the cosine lobe are 1.
TEST(Furnace, AWhiteSurfaceCannotBeSeen) {
  for (const auto& mesh : {sphere_mesh(), box_mesh()}) {
    const auto scene = in_furnace(material_of(lambert(1)), mesh);
    const auto r = rendered(scene, {.samples = 16});
    for (const float x : r.picture.rgb) ASSERT_NEAR(x, 1, 2e-5);  // of up to a dozen bounces in float
    EXPECT_EQ(r.film.rejected(), 0u);
  }
}

// A convex surface of albedo rho is rho.
TEST(Furnace, AConvexSurfaceIsItsAlbedo) {
  auto scene = in_furnace(material_of(lambert(0.3)), sphere_mesh());
  scene.cameras = {camera_at({0, 0, 5}, {0, 0, 0}, 8, 8, 20)};
  const auto r = rendered(scene, {.samples = 64});
  for (const float x : r.picture.rgb) ASSERT_NEAR(x, 0.3, 1e-5);  // it meets nothing else, so there is no roulette
}

// A sphere that meets nothing else, seen at the middle from straight above: the albedo of its model for that view, by
// quadrature. Every model, smooth to rough; 5 standard errors of a dozen seeds.
double albedo(const brdf::AnyBrdf& any) {
  return std::visit(
      [](const auto& model) {
        constexpr int kSteps = 4000;
        const brdf::Vec3<double> view(0, 0, 1);
        double sum = 0;  // in the half angle's tangent, which resolves narrow lobes; the view makes it round
        for (int i = 0; i < kSteps; ++i) {
          const double t0 = std::pow(10, -8 + 8.0 * i / kSteps), t1 = std::pow(10, -8 + 8.0 * (i + 1) / kSteps);
          const double half = std::atan(std::sqrt(t0 * t1)), theta = 2 * half;
          if (theta >= 1.5707963) break;
          const double width = 2 * (std::atan(t1) - std::atan(t0));
          const brdf::Vec3<double> light(std::sin(theta), 0, std::cos(theta));
          sum += model.eval(light, view).g * std::cos(theta) * std::sin(theta) * width;
        }
        return 2 * 3.14159265358979 * sum;
      },
      any);
}

TEST(Furnace, EveryModelReturnsWhatItsQuadratureSays) {
  std::vector<std::pair<std::string, brdf::AnyBrdf>> all;
  for (const auto name : brdf::kModelNames) {
    brdf::AnyBrdf model;
    ASSERT_TRUE(brdf::model_of_name(name, model));
    all.emplace_back(std::string(name), model);
  }
  for (const double roughness : {0.0, 0.1, 0.3, 1.0}) {
    brdf::Ggx<double> ggx;
    ggx.f0 = brdf::Rgb<double>(1.0);
    if constexpr (requires { ggx.roughness; }) ggx.roughness = roughness;
    all.emplace_back("ggx " + std::to_string(roughness), ggx);
    brdf::Callisto<double> c;
    c.roughness = roughness, c.metallic = 0.3, c.diffuse_fresnel = 3, c.retroreflection = 2, c.smooth_terminator = 0.5;
    c.specular_fresnel_falloff = 0.7, c.dual_specular_opacity = 0.4;
    all.emplace_back("callisto " + std::to_string(roughness), c);
  }
  for (const auto& [name, model] : all) {
    auto scene = in_furnace(material_of(model), sphere_mesh());
    scene.cameras = {camera_at({0, 0, 5}, {0, 0, 0}, 2, 2, 20000)};
    const Estimate e = estimate(scene, {.samples = 1024});
    const double exact = albedo(model);
    EXPECT_NEAR(e.mean, exact, 5 * e.error + 2e-3 * exact) << name;
  }
}

// In a closed room of albedo rho whose walls all emit E, radiance is E / (1 - rho) everywhere.
TEST(Furnace, AClosedRoomIsItsSeries) {
  for (const double rho : {0.0, 0.2, 0.5, 0.8}) {
    auto scene = in_furnace(material_of(lambert(rho)), box_mesh());
    scene.environment.reset();
    scene.materials[0].emission = {1, 1, 1};
    scene.cameras = {camera_at({0.1f, 0.2f, 0.3f}, {1, 0.5f, 0.2f}, 8, 8)};
    const Estimate e = estimate(scene, {.samples = 64, .max_bounces = 1000});
    EXPECT_NEAR(e.mean, 1 / (1 - rho), 4 * e.error + 1e-4) << rho;
    EXPECT_LT(e.error, 0.01 / (1 - rho));
    for (const int bounces : {0, 1, 3}) {  // and cut off after so many, its partial sum
      const Estimate cut = estimate(scene, {.samples = 64, .max_bounces = bounces});
      EXPECT_NEAR(cut.mean, (1 - std::pow(rho, bounces + 1)) / (1 - rho), 4 * cut.error + 1e-4)
          << rho << " " << bounces;
    }
  }
}

// The same far from the origin, where a float has steps of a millimeter.
TEST(Furnace, AClosedRoomIsItsSeriesTenKilometersAway) {
  auto scene = in_furnace(material_of(lambert(0.5)), box_mesh());
  scene.environment.reset();
  scene.materials[0].emission = {1, 1, 1};
  const glm::vec3 far{6000, -200, 8000};
  scene.instances[0].world_from_object = placed(far, 10);
  scene.cameras = {camera_at(far + glm::vec3(1, 2, 3), far + glm::vec3(10, 5, 2), 8, 8)};
  const Estimate e = estimate(scene, {.samples = 64, .max_bounces = 1000});
  EXPECT_NEAR(e.mean, 2, 0.1);  // measured -3.9 %: near edges, offsets of 0.1 to 0.25 m lead past a wall of 20 m
}

}  // namespace
}  // namespace likeness::reference
