#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "render/reference/reference.h"
#include "render/runtime/pipeline.h"
#include "tests/render/runtime/scenes.h"

// Where the run-time pipeline approximates nothing it is the path tracer, one bounce long.
namespace likeness::runtime {
namespace {

image::Picture reference_of(const scene::Scene& s, std::uint32_t samples, std::uint32_t seed = 0) {
  const world::World world(s, plan::plan_of(s));
  reference::Options options;
  options.samples = samples, options.max_bounces = 1, options.seed = seed;
  reference::Film film(s.cameras[0].width, s.cameras[0].height, false);
  reference::render(world, options, film, [](const auto&) { return true; });
  EXPECT_EQ(film.rejected(), 0u);
  return film.picture();
}

image::Picture frame_of(const scene::Scene& s, const Settings& settings, bool force_all = false, int threads = 0) {
  const world::World world(s, plan::plan_of(s, 0, force_all));
  return Pipeline(world).frame(0, settings, threads);
}

double mean(const image::Picture& p) {
  double sum = 0;
  for (const float x : p.rgb) sum += static_cast<double>(x);
  return sum / static_cast<double>(p.rgb.size());
}

// Over the mean of the reference.
double largest_difference(const image::Picture& a, const image::Picture& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(a.rgb[i]) - static_cast<double>(b.rgb[i])) /
                                    (std::abs(static_cast<double>(b.rgb[i])) + mean(b)));
  return largest;
}
double quantile_of_difference(const image::Picture& a, const image::Picture& b, double share) {
  const double grey = 0.1 * mean(b);
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    differences.push_back(std::abs(static_cast<double>(a.rgb[i]) - static_cast<double>(b.rgb[i])) /
                          (std::abs(static_cast<double>(b.rgb[i])) + grey));
  std::sort(differences.begin(), differences.end());
  return differences[static_cast<std::size_t>(share * static_cast<double>(differences.size()))];
}
double rms_difference(const image::Picture& a, const image::Picture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double d = static_cast<double>(a.rgb[i]) - static_cast<double>(b.rgb[i]);
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(a.rgb.size())) / mean(b);
}

// One light without a size: both look at the same points of each pixel, so they agree sample by sample.
void expect_equal_light(const scene::LightShape& shape) {
  scene::Scene s = test::spheres();
  test::add_light(s, shape);
  Settings settings;
  settings.pixel_samples = 4;
  const image::Picture reference = reference_of(s, 4), frame = frame_of(s, settings);
  EXPECT_GT(mean(reference), 0);
  // 1e-4: the view of a cell is taken from its rounded position, and a highlight of roughness 0.25 is steep (2e-5 met).
  EXPECT_LT(largest_difference(frame, reference), 1e-4);
}

TEST(Agreement, PointLight) { expect_equal_light(scene::PointLight{{1, 3, 2}, {20, 18, 15}}); }
TEST(Agreement, SpotLight) {
  expect_equal_light(
      scene::SpotLight{{1, 4, 2}, glm::normalize(glm::vec3(-0.3f, -1, -0.5f)), {60, 60, 50}, 0.2f, 0.5f});
}
TEST(Agreement, DirectionalLight) {
  expect_equal_light(scene::DirectionalLight{glm::normalize(glm::vec3(-1, -1, -0.5f)), {3, 3, 3}});
}

// Lights with a size: both converge to the same picture.
void expect_same(scene::Scene& s, Settings settings) {
  s.cameras[0] = test::camera_at({0, 1.5f, 5}, {0, 0.7f, 0}, 35, 48, 32);
  settings.pixel_samples = 16;
  const image::Picture reference = reference_of(s, 1024), frame = frame_of(s, settings);
  // 16 points do for a pixel's edges: means agree to 1e-3, and nine values in ten to a few per cent. The others are edges,
  // and the noise of 1024 paths in the highlights of the metal.
  EXPECT_LT(std::abs(mean(frame) / mean(reference) - 1), 4e-3);
  EXPECT_LT(quantile_of_difference(frame, reference, 0.9), 0.05);
}
void expect_same_light(const scene::LightShape& shape) {
  scene::Scene s = test::spheres();
  test::add_light(s, shape);
  Settings settings;
  settings.light_samples = 64;
  expect_same(s, settings);
}

TEST(Agreement, RectangleLight) {
  expect_same_light(scene::RectangleLight{{0, 3.5f, 1}, {0.7f, 0, 0}, {0, 0, 0.5f}, {9, 9, 9}, true});
}
TEST(Agreement, DiskLight) { expect_same_light(scene::DiskLight{{0, 3.5f, 1}, {0, -1, 0}, 0.6f, {9, 9, 9}, false}); }
TEST(Agreement, SphereLight) { expect_same_light(scene::SphereLight{{0, 3.5f, 1}, 0.4f, {9, 9, 9}}); }

TEST(Agreement, SurfacesThatShine) {
  scene::Scene s = test::spheres();
  const scene::Index glow = test::add_material(s, brdf::Lambert<double>{}, "glow");
  s.materials[glow].emission = {8, 8, 8};
  test::add_quad(s, glow, {-0.6f, 3, 0.5f}, {0.6f, 3, 0.5f}, {0.6f, 3, 1.5f}, {-0.6f, 3, 1.5f});
  Settings settings;
  settings.light_samples = 64;
  expect_same(s, settings);
}

TEST(Agreement, EnvironmentByRays) {
  scene::Scene s = test::spheres();
  scene::Image sky;
  sky.name = "sky";
  sky.texels.width = 8, sky.texels.height = 4, sky.texels.channels = 3;
  for (int i = 0; i < 32; ++i) {
    const float x = i == 10 ? 9.0f : 0.3f;
    sky.texels.floats.insert(sky.texels.floats.end(), {x, x, 0.5f * x});
  }
  s.images.push_back(sky);
  s.environment = scene::Environment{0, {1, 1, 1}, 0.4f};
  Settings settings;
  settings.environment = EnvironmentLevel::kRays16;
  expect_same(s, settings);
  const double shadowed = mean(frame_of(s, settings));
  settings.environment = EnvironmentLevel::kMaps;
  EXPECT_GT(mean(frame_of(s, settings)), shadowed);  // maps know no shadow
}

// A white environment on a convex body: maps have nothing to leave out but the blur's own error.
TEST(Agreement, MapsOfAWhiteEnvironmentReturnWhatTheLobesReturn) {
  for (const double roughness : {0.1, 0.4, 0.8}) {
    scene::Scene s;
    s.cameras.push_back(test::camera_at({0, 0, 5}, {0, 0, 0}, 26, 48, 48));
    brdf::Callisto<double> c;
    c.metallic = 1, c.base_color = {1, 1, 1}, c.roughness = roughness;
    test::add_sphere(s, test::add_material(s, c), {0, 0, 0}, 1);
    s.environment = scene::Environment{};
    Settings settings;
    settings.pixel_samples = 4;
    const image::Picture reference = reference_of(s, 256), frame = frame_of(s, settings);
    EXPECT_LT(std::abs(mean(frame) / mean(reference) - 1), 5e-3) << roughness;
    EXPECT_LT(rms_difference(frame, reference), 0.02) << roughness;  // the table's 32 steps at grazing views
  }
}

TEST(Agreement, ForcedEffectsChangeNothing) {
  scene::Scene s = test::spheres();
  test::add_light(s, scene::PointLight{{1, 3, 2}, {20, 18, 15}});
  Settings settings;
  settings.pixel_samples = 4;
  EXPECT_LT(largest_difference(frame_of(s, settings, true), frame_of(s, settings, false)), 1e-6);
}

TEST(Agreement, TheFrameDoesNotDependOnTheThreads) {
  scene::Scene s = test::spheres();
  test::add_light(s, scene::SphereLight{{0, 3.5f, 1}, 0.4f, {9, 9, 9}});
  s.environment = scene::Environment{};
  EXPECT_EQ(frame_of(s, {}, false, 1).rgb, frame_of(s, {}, false, 3).rgb);
}

// An orthographic camera: every pixel in the same direction, so the spheres' edges are circles of their radius, and both
// integrators shade them alike.
TEST(Agreement, AnOrthographicCameraSeesWhatThePathTracerSees) {
  scene::Scene s = test::spheres();
  test::add_light(s, scene::DirectionalLight{glm::normalize(glm::vec3(-1, -2, -1.5f)), glm::vec3(3)});
  scene::Camera& camera = s.cameras[0];
  camera.is_orthographic = true;
  camera.focal_x = camera.focal_y = 24;  // pixels a metre
  Settings settings;
  settings.pixel_samples = 64;
  const image::Picture want = reference_of(s, 256), got = frame_of(s, settings);
  EXPECT_NEAR(mean(got), mean(want), 0.01 * mean(want));
  // Edges of 64 and of 256 samples differ by the noise of a share.
  EXPECT_LT(largest_difference(got, want), 0.35);

  // The camera looks down a little at the spheres' middles: where they are on the picture follows from its axes alone.
  const world::World world(s, plan::plan_of(s));
  const world::Camera eye(s.cameras[0]);
  const glm::mat3 axes(camera.world_from_camera);
  const glm::vec3 middle = glm::vec3(-0.9f, 0.8f, 0) - glm::vec3(camera.world_from_camera[3]);
  const glm::vec2 at(48 + 24 * glm::dot(middle, axes[0]), 32 - 24 * glm::dot(middle, axes[1]));
  for (int i = 0; i < 64; ++i) {
    const float angle = 0.0981748f * static_cast<float>(i);
    const glm::vec2 way(std::cos(angle), std::sin(angle));
    const auto met = [&](float radius) {
      const ray::Hit hit = world.tracer.closest(eye.ray(at + 24 * radius * way));
      return hit.is_some() && hit.surface == 0;
    };
    EXPECT_TRUE(met(0.8f * 0.999f)) << i;
    EXPECT_FALSE(met(0.8f * 1.001f)) << i;
  }
}

}  // namespace
}  // namespace likeness::runtime
