#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "render/ray/offset.h"
#include "render/world/camera.h"
#include "tests/render/reference/small_scenes.h"

// What the path tracer says of direct light against two estimates that share none of its code: by directions to lights
// alone, and by directions of the surface alone.
namespace likeness::reference {
namespace {

struct Light {
  const char* name;
  std::function<void(scene::Scene&)> add;
};
struct Surface {
  const char* name;
  scene::Material material;
  bool has_chance_lights;  // directions to lights have a variance that can be measured
};

scene::Scene stage(const Light& light, const Surface& surface, bool is_grazing) {
  scene::Scene scene;
  scene.meshes = {square_mesh()};
  scene.materials = {surface.material};
  scene.instances = {{"floor", 0, 0, placed({0, 0, 0}, 20)}};
  light.add(scene);
  // It looks at the place where a mirror shows the middle of the light.
  scene.cameras = {is_grazing ? camera_at({12, 0.35f, 0}, {0, 0, 0}, 4, 4, 300)
                              : camera_at({1, 2, 0}, {0, 0, 0}, 4, 4, 8)};
  return scene;
}

// One sample of direct light by one of the two alone.
glm::vec3 by_lights(const world::World& world, const surface::Point& p, sampling::Samples& samples) {
  const glm::vec2 choice = samples.next(), u = samples.next();
  const light::Sample s = world.lights.sample(p.position, p.shading_normal, choice.x, u);
  if (!s.is_some()) return glm::vec3(0);
  const float far = s.distance == ray::kFar ? ray::kFar : s.distance * 0.9999f;
  if (world.tracer.occluded({ray::beside(p.position, p.normal), 0, s.to_light, far})) return glm::vec3(0);
  return p.eval(s.to_light).f_cos * s.value;
}
glm::vec3 by_surface(const world::World& world, const surface::Point& p, sampling::Samples& samples) {
  const glm::vec2 choice = samples.next(), u = samples.next();
  const surface::Direction d = p.sample(choice.x, u);
  if (!(d.pdf > 0)) return glm::vec3(0);
  const ray::Ray ray{ray::beside(p.position, p.normal), 0, d.to_light, ray::kFar};
  const ray::Hit hit = world.tracer.closest(ray);
  if (!hit.is_some())
    return world.lights.environment() ? d.weight * world.lights.environment()->radiance(d.to_light) : glm::vec3(0);
  const std::size_t instances = world.scene.instances.size();
  if (hit.surface >= instances)
    return d.weight * world.lights.radiance(hit.surface - instances, d.to_light, hit.distance, hit.normal);
  surface::Point other;
  world.surfaces.at<surface::Detail::kTextures>(ray, hit, other);
  return d.weight * world.surfaces.emission(other);
}

Estimate alone(const scene::Scene& scene, bool is_by_lights, int batches, std::uint32_t samples) {
  const world::World world(scene, plan::plan_of(scene));
  const world::Camera camera(scene.cameras[0]);
  double sum = 0, squares = 0;
  for (int batch = 0; batch < batches; ++batch) {
    double mean = 0;
    for (std::uint32_t pixel = 0; pixel < 16; ++pixel)
      for (std::uint32_t i = 0; i < samples; ++i) {
        sampling::Samples numbers(pixel, i, 5000 + static_cast<std::uint32_t>(batch));
        const ray::Ray ray = camera.ray(glm::vec2(pixel % 4, pixel / 4) + numbers.next());
        const ray::Hit hit = world.tracer.closest(ray, ray::Seen::kSurfaces);
        if (!hit.is_some()) continue;
        surface::Point p;
        world.surfaces.at<surface::Detail::kTextures>(ray, hit, p);
        const glm::vec3 x = is_by_lights ? by_lights(world, p, numbers) : by_surface(world, p, numbers);
        mean += static_cast<double>(x.g) / (16.0 * samples);
      }
    sum += mean, squares += mean * mean;
  }
  const double mean = sum / batches;
  return {mean, std::sqrt(std::max(squares / batches - mean * mean, 0.0) / (batches - 1))};
}

std::vector<Light> all_lights() {
  return {
      {"rectangle",
       [](scene::Scene& s) {
         s.lights = {{"", scene::RectangleLight{{-1.5f, 2, 0}, {1, 0, 0}, {0, 0, 1}, {2, 2, 2}}}};
       }},
      {"tall rectangle",
       [](scene::Scene& s) { s.lights = {{"", scene::RectangleLight{{-8, 1, 0}, {0, 1, 0}, {0, 0, 2}, {2, 2, 2}}}}; }},
      {"disk",
       [](scene::Scene& s) {
         s.lights = {{"", scene::DiskLight{{-1.5f, 2, 0}, glm::normalize(glm::vec3(1, -1, 0)), 1, {2, 2, 2}}}};
       }},
      {"sphere", [](scene::Scene& s) { s.lights = {{"", scene::SphereLight{{-2, 2, 0}, 1.5f, {2, 2, 2}}}}; }},
      {"sphere within a range",
       [](scene::Scene& s) {
         s.lights = {{"", scene::SphereLight{{-2, 2, 0}, 1.5f, {2, 2, 2}}}};
         s.lights[0].range = 4;
       }},
      {"two lights",
       [](scene::Scene& s) {
         s.lights = {{"", scene::SphereLight{{-2, 2, 1.5f}, 1, {2, 2, 2}}},
                     {"", scene::DiskLight{{-2, 2, -1.5f}, glm::normalize(glm::vec3(1, -1, 0)), 1, {1, 1, 1}}}};
       }},
      {"emissive box",
       [](scene::Scene& s) {
         s.meshes.push_back(box_mesh());
         s.materials.push_back(material_of(lambert(0)));
         s.materials[1].emission = {2, 2, 2};
         s.instances.push_back(
             {"box", 1, 1, glm::rotate(placed({-2, 2, 0}, 0.8f), 0.4f, glm::normalize(glm::vec3(1, 2, 3)))});
       }},
      {"environment",
       [](scene::Scene& s) {
         scene::Image sky{"", {16, 8, 1, {}, {}}};
         for (int y = 0; y < 8; ++y)
           for (int x = 0; x < 16; ++x) sky.texels.floats.push_back(y < 4 && x >= 3 && x <= 5 ? 4.0f : 0.1f);
         s.images = {sky};
         s.environment = scene::Environment{0, {1, 1, 1}, 0};
       }},
  };
}
std::vector<Surface> all_surfaces() {
  brdf::Callisto<double> skin;
  skin.roughness = 0.5, skin.diffuse_fresnel = 4, skin.retroreflection = 3, skin.smooth_terminator = 0.6;
  skin.specular_fresnel_falloff = 0.7, skin.dual_specular_opacity = 0.5, skin.dual_specular_roughness_scale = 1.6;
  brdf::Callisto<double> mirror;
  mirror.metallic = 1, mirror.roughness = 0;
  brdf::Callisto<double> lacquer;
  lacquer.roughness = 0.2;
  return {{"lambert", material_of(lambert(0.7)), true},
          {"callisto, all parts", material_of(skin), true},
          {"callisto, lacquer", material_of(lacquer), true},
          {"callisto, alpha 1e-4", material_of(mirror), false}};
}

TEST(Estimators, AgreeForEveryLightAndSurface) {
  // 8 lights x 4 surfaces x 2 views, two comparisons each but for the mirrors: 112 together. 4.5 standard errors of 16
  // batches each: Welch's t with 20 to 30 degrees of freedom is beyond it with p = 1e-4 to 2e-4, all of them 2 %.
  constexpr double kSigmas = 4.5;
  int unseen = 0;
  for (const Light& light : all_lights())
    for (const Surface& surface : all_surfaces())
      for (const bool is_grazing : {false, true}) {
        SCOPED_TRACE(std::string(light.name) + ", " + surface.name + (is_grazing ? ", grazing" : ""));
        const auto scene = stage(light, surface, is_grazing);
        const Estimate both = estimate(scene, {.samples = 64, .max_bounces = 1}, 16);
        const Estimate surfaces = alone(scene, false, 16, 256);
        const auto expect_equal = [&](const Estimate& a, const Estimate& b) {
          EXPECT_NEAR(a.mean, b.mean, kSigmas * std::sqrt(a.error * a.error + b.error * b.error) + 2e-4 * a.mean);
        };
        if (!(surfaces.mean > 1e-5)) {  // a mirror that does not show the light
          EXPECT_LT(both.mean, 1e-4);
          EXPECT_FALSE(surface.has_chance_lights);
          ++unseen;
          continue;
        }
        expect_equal(both, surfaces);
        EXPECT_LT(both.error, 0.05 * both.mean);
        if (surface.has_chance_lights) expect_equal(both, alone(scene, true, 16, 256));
      }
  EXPECT_LE(unseen, 8);  // half of the 16 mirrors show one
}

// The point of weighting two estimates: neither's worst case is its own.
TEST(Estimators, TogetherAreNeverMuchWorseThanTheBetterOne) {
  const auto lights = all_lights();
  const auto surfaces = all_surfaces();
  for (const std::size_t surface : {0u, 2u}) {
    const auto scene = stage(lights[0], surfaces[surface], false);
    const Estimate both = estimate(scene, {.samples = 64, .max_bounces = 1}, 32);
    const Estimate a = alone(scene, true, 32, 64), b = alone(scene, false, 32, 64);
    // Measured: 6.3 for Lambert, where directions to the light alone are smooth and converge as n^-3/2.
    EXPECT_LT(both.error, 8 * std::min(a.error, b.error)) << surface;
    EXPECT_LT(both.error, 0.5 * std::max(a.error, b.error)) << surface;
  }
}

}  // namespace
}  // namespace likeness::reference
