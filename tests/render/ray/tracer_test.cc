#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "render/ray/frame.h"
#include "render/ray/tracer.h"
#include "render/sampling/sobol.h"

namespace likeness::ray {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A stream of numbers without a pattern.
struct Random {
  std::uint32_t state = 1;
  float next() { return sampling::unit(state = sampling::mixed(state + 0x9e3779b9u)); }
  glm::vec3 in_box(float half) { return {half * (2 * next() - 1), half * (2 * next() - 1), half * (2 * next() - 1)}; }
};

// The unit square z = 0 about the origin, of two triangles, facing +z.
scene::Mesh square() {
  scene::Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}
scene::Mesh sphere() {
  scene::Mesh mesh;
  mesh.is_sphere = true;
  return mesh;
}
glm::mat4 moved(const glm::vec3& by, float scale = 1) {
  return glm::scale(glm::translate(glm::mat4(1), by), glm::vec3(scale));
}
// A square at z = 0, a sphere of radius 1/2 at z = -2, lights of each shape before them, and random triangles.
scene::Scene crowd() {
  scene::Scene scene;
  scene.meshes = {square(), sphere(), {}};
  Random random;
  for (scene::Index i = 0; i < 300; ++i) {
    const glm::vec3 p = random.in_box(3);
    for (int k = 0; k < 3; ++k) scene.meshes[2].positions.push_back(p + random.in_box(0.4f));
    scene.meshes[2].triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  scene.materials.resize(1);
  scene.instances = {
      {"square", 0, 0, glm::mat4(1)}, {"ball", 1, 0, moved({0, 0, -2}, 0.5f)}, {"soup", 2, 0, moved({8, 0, 0})}};
  scene.lights = {{"r", scene::RectangleLight{{0, 0, 2}, {0.5f, 0, 0}, {0, 0.5f, 0}}},
                  {"d", scene::DiskLight{{2, 0, 2}, {0, 0, 1}, 0.5f}},
                  {"s", scene::SphereLight{{-2, 0, 2}, 0.5f}},
                  {"p", scene::PointLight{}},
                  {"hidden", scene::SphereLight{{0, 2, 2}, 0.5f}}};
  scene.lights[4].is_visible = false;
  return scene;
}

TEST(Tracer, SaysWhatWasMetAndWhere) {
  const auto scene = crowd();
  const Tracer tracer(scene, {});
  const Hit square = tracer.closest({{0.5f, -0.25f, 1}, 0, {0, 0, -1}});
  ASSERT_TRUE(square.is_some());
  EXPECT_EQ(square.surface, 0u);
  EXPECT_EQ(square.triangle, 0u);
  EXPECT_FLOAT_EQ(square.distance, 1);
  // Weights of the second and third corner: p = (1 - u - v) a + u b + v c.
  const glm::vec3 a{-1, -1, 0}, b{1, -1, 0}, c{1, 1, 0};
  EXPECT_LT(glm::distance((1 - square.u - square.v) * a + square.u * b + square.v * c, glm::vec3(0.5f, -0.25f, 0)),
            1e-6f);
  EXPECT_GT(std::abs(glm::normalize(square.normal).z), 0.999f);
  EXPECT_EQ(tracer.closest({{-0.5f, 0.25f, 1}, 0, {0, 0, -1}}).triangle, 1u);

  const Hit ball = tracer.closest({{0, 0.3f, -5}, 0, {0, 0, 1}});
  EXPECT_EQ(ball.surface, 1u);
  EXPECT_NEAR(ball.distance, 5 - 2 - 0.4, 1e-5);
  EXPECT_EQ(ball.u, 0);
  EXPECT_EQ(ball.v, 0);
  EXPECT_LT(glm::distance(glm::normalize(ball.normal), glm::vec3(0, 0.6f, -0.8f)), 1e-5f);
  // From within.
  EXPECT_NEAR(tracer.closest({{0, 0, -2}, 0, {0, 0, 1}}).distance, 0.5, 1e-5);

  EXPECT_FALSE(tracer.closest({{0, 0, 100}, 0, {0, 0, 1}}).is_some());
  EXPECT_EQ(tracer.closest({{0, 0, 100}, 0, {0, 0, 1}}).distance, kFar);
}

TEST(Tracer, LightsAreMetButNeverHideAnything) {
  const auto scene = crowd();
  const Tracer tracer(scene, {});
  const std::size_t first = scene.instances.size();
  for (std::size_t i = 0; i < 3; ++i) {
    const float x = i == 0 ? 0.0f : i == 1 ? 2.0f : -2.0f;
    const Ray ray{{x, 0, 5}, 0, {0, 0, -1}, 4};
    EXPECT_EQ(tracer.closest(ray).surface, first + i);
    EXPECT_FALSE(tracer.occluded(ray)) << i;
    std::uint8_t is_occluded = 2;
    Hit hit;
    tracer.occluded(std::span(&ray, 1), std::span(&is_occluded, 1));
    tracer.closest(std::span(&ray, 1), std::span(&hit, 1));
    EXPECT_EQ(is_occluded, 0) << i;
    EXPECT_EQ(hit.surface, first + i) << i;
  }
  // Of the right size: just inside and just outside of each.
  const auto light_at = [&](float x, float y) { return tracer.closest({{x, y, 5}, 0, {0, 0, -1}, 3.6f}).surface; };
  EXPECT_EQ(light_at(0.49f, 0.49f), first);
  EXPECT_EQ(light_at(0.51f, 0), scene::kNone);
  EXPECT_EQ(light_at(0, -0.51f), scene::kNone);
  EXPECT_EQ(light_at(2.34f, 0.34f), first + 1);
  EXPECT_EQ(light_at(2.4f, 0.4f), scene::kNone);
  EXPECT_EQ(light_at(-2.3f, 0.3f), first + 2);
  EXPECT_EQ(light_at(-2.4f, 0.4f), scene::kNone);
  EXPECT_EQ(light_at(0, 2), scene::kNone);  // not visible
  EXPECT_TRUE(tracer.occluded({{0, 0, 5}, 0, {0, 0, -1}, 10}));
  EXPECT_FALSE(tracer.occluded({{0, 0, 5}, 0, {0, 0, -1}, 4.9f}));
}

TEST(Tracer, PacketsAreWhatSingleRaysAre) {
  const auto scene = crowd();
  const Tracer tracer(scene, {});
  Random random;
  for (const std::size_t count :
       {std::size_t{1}, std::size_t{7}, std::size_t{16}, std::size_t{17}, std::size_t{1000}}) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec3 from = random.in_box(12),
                      to = i % 4 == 0 ? random.in_box(3) : glm::vec3(8, 0, 0) + random.in_box(3);
      rays.push_back({from, i % 5 == 0 ? 0.3f : 0.0f, i % 3 == 0 ? to - from : glm::normalize(to - from),
                      i % 7 == 0 ? 5.0f : kFar});
      if (i % 11 == 3) rays.back().far = -1;
      if (i % 13 == 5) rays.back() = {from, 4, to - from, 3};
    }
    std::vector<Hit> hits(count);
    std::vector<std::uint8_t> is_occluded(count, 7);
    tracer.closest(rays, hits);
    tracer.occluded(rays, is_occluded);
    std::size_t met = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Hit one = tracer.closest(rays[i]);
      ASSERT_EQ(hits[i].surface, one.surface) << i;
      ASSERT_EQ(hits[i].triangle, one.triangle) << i;
      if (one.is_some()) {
        ++met;
        ASSERT_NEAR(hits[i].distance, one.distance, 1e-5f * (1 + one.distance)) << i;
        ASSERT_NEAR(hits[i].u, one.u, 1e-4f);  // of small triangles seen from 10 m
        ASSERT_NEAR(hits[i].v, one.v, 1e-4f);
        ASSERT_GT(one.distance, rays[i].near);
        ASSERT_LE(one.distance, rays[i].far);
      } else {
        ASSERT_EQ(hits[i].distance, kFar);
      }
      ASSERT_EQ(is_occluded[i] != 0, tracer.occluded(rays[i])) << i;
      if (rays[i].far < rays[i].near) {
        ASSERT_FALSE(one.is_some()) << i;
        ASSERT_EQ(is_occluded[i], 0) << i;
      }
    }
    if (count == 1000) {
      EXPECT_GT(met, 100u);
    }
  }
  tracer.closest(std::span<const Ray>(), std::span<Hit>());
  tracer.occluded(std::span<const Ray>(), std::span<std::uint8_t>());
}

TEST(Tracer, WatertightLetsNoRayThroughAnEdge) {
  const auto scene = crowd();
  const Tracer tracer(scene, {});
  Random random;
  for (int i = 0; i < 100000; ++i) {  // at the diagonal of the square
    const float t = 1.98f * random.next() - 0.99f;
    const glm::vec3 from{random.next(), random.next(), 1}, to{t, t, 0};
    ASSERT_TRUE(tracer.closest({from, 0, to - from, 1.01f}).is_some()) << t;
  }
}

// Solid in the right half of each triangle's u.
bool is_solid(const void* context, scene::Index instance, scene::Index, float u, float) {
  return instance != *static_cast<const scene::Index*>(context) || u > 0.5f;
}

TEST(Tracer, CutOutsAreAskedAndOnlyWhereThereAreAny) {
  auto scene = crowd();
  scene.lights.clear();
  scene.instances.push_back({"behind", 0, 0, moved({0, 0, -1})});
  scene.materials.resize(2);
  scene.materials[1].opacity = scene::Texture{};
  scene.instances[0].material = 1;
  const scene::Index cut = 0;
  TracerOptions options{.has_cut_outs = true, .cut_outs = {&cut, &is_solid}};
  const Tracer tracer(scene, options);
  // Triangle 0: corners (-1, -1), (1, -1), (1, 1): u = (x - y) / 2.
  const Ray solid{{0.8f, -0.8f, 1}, 0, {0, 0, -1}, 1.5f}, hole{{0.3f, -0.1f, 1}, 0, {0, 0, -1}, 1.5f};
  EXPECT_EQ(tracer.closest(solid).surface, 0u);
  EXPECT_FALSE(tracer.closest(hole).is_some());
  EXPECT_TRUE(tracer.occluded(solid));
  EXPECT_FALSE(tracer.occluded(hole));
  auto far_hole = hole;
  far_hole.far = kFar;
  EXPECT_EQ(tracer.closest(far_hole).surface, 3u);  // what is behind it
  const std::vector<Ray> rays{solid, hole, far_hole, solid, hole};
  std::vector<Hit> hits(5);
  std::vector<std::uint8_t> is_occluded(5);
  tracer.closest(rays, hits), tracer.occluded(rays, is_occluded);
  EXPECT_EQ(hits[0].surface, 0u);
  EXPECT_FALSE(hits[1].is_some());
  EXPECT_EQ(hits[2].surface, 3u);
  EXPECT_EQ(is_occluded, (std::vector<std::uint8_t>{1, 0, 1, 1, 0}));
  options.has_cut_outs = false;
  EXPECT_EQ(Tracer(scene, options).closest(hole).surface, 0u);
}

TEST(Tracer, OfAnEmptySceneMeetsNothing) {
  const scene::Scene nothing;
  const Tracer tracer(nothing, {});
  EXPECT_FALSE(tracer.closest({}).is_some());
  EXPECT_FALSE(tracer.occluded({}));
  EXPECT_EQ(tracer.triangles(), 0u);
  scene::Scene scene;
  scene.meshes.resize(1);  // without triangles
  scene.materials.resize(1);
  scene.instances = {{"", 0, 0, glm::mat4(1)}};
  const Tracer empty(scene, {});
  EXPECT_FALSE(empty.closest({}).is_some());
  EXPECT_EQ(empty.vertices(0), nullptr);
}

TEST(Tracer, BadRaysAndTrianglesEnd) {
  auto scene = crowd();
  scene.meshes[2].triangles.push_back({0, 0, 0});
  scene.meshes[2].triangles.push_back({0, 1, 1});
  scene.meshes[2].positions.push_back({kNan, 0, 0});
  scene.meshes[2].triangles.push_back({0, 1, static_cast<scene::Index>(scene.meshes[2].positions.size() - 1)});
  const Tracer tracer(scene, {});
  const glm::vec3 nan(kNan), zero(0), infinite(std::numeric_limits<float>::infinity()), one(1);
  std::vector<Ray> rays;
  for (const glm::vec3& from : {nan, zero, infinite, one})
    for (const glm::vec3& way : {nan, zero, infinite, one, glm::vec3(1e-30f), glm::vec3(1e30f)})
      for (const float far : {kNan, kFar, 1.0f, -1.0f}) rays.push_back({from, 0, way, far});
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> is_occluded(rays.size());
  tracer.closest(rays, hits), tracer.occluded(rays, is_occluded);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit hit = tracer.closest(rays[i]);
    if (!(rays[i].far >= 0)) {
      EXPECT_FALSE(hit.is_some()) << i;
      EXPECT_FALSE(hits[i].is_some()) << i;
      EXPECT_FALSE(tracer.occluded(rays[i])) << i;
      EXPECT_EQ(is_occluded[i], 0) << i;
    }
    if (std::isnan(rays[i].origin.x) || std::isnan(rays[i].direction.x)) {
      EXPECT_FALSE(hit.is_some()) << i;
    }
  }
}

TEST(Tracer, VerticesAreOfTheWorldAndSpheresAreSimilar) {
  auto scene = crowd();
  scene.instances[0].world_from_object = moved({1, 2, 3}, 2);
  const Tracer tracer(scene, {});
  const float* v = tracer.vertices(0);
  ASSERT_NE(v, nullptr);
  EXPECT_EQ(glm::vec3(v[3], v[4], v[5]), glm::vec3(3, 0, 3));
  EXPECT_EQ(tracer.vertices(1), nullptr);
  EXPECT_EQ(tracer.triangles(), 302u);
  EXPECT_GT(tracer.bytes(), 1000u);
  scene.instances[1].world_from_object = glm::scale(glm::mat4(1), {1, 2, 1});
  EXPECT_THROW(Tracer(scene, {}), std::runtime_error);
  scene.instances[1].world_from_object = glm::rotate(moved({0, 0, -2}, 0.5f), 1.0f, glm::normalize(glm::vec3(1, 2, 3)));
  EXPECT_NEAR(Tracer(scene, {}).closest({{0, 0, -9}, 0, {0, 0, 1}}).distance, 6.5, 1e-5);
}

TEST(Frame, IsRightHandedUnitAndSquareEverywhere) {
  Random random;
  for (int i = 0; i < 20000; ++i) {
    glm::vec3 n = glm::normalize(random.in_box(1));
    if (i < 4) n = {0, 0, i % 2 ? 1.0f : -1.0f};
    if (i % 5 == 0) n = glm::normalize(glm::vec3(1e-4f * n.x, 1e-4f * n.y, n.z < 0 ? -1 : 1));
    const Frame f(n);
    ASSERT_NEAR(glm::length(f.x), 1, 2e-6);
    ASSERT_NEAR(glm::length(f.y), 1, 2e-6);
    ASSERT_NEAR(glm::dot(f.x, f.y), 0, 2e-6);
    ASSERT_NEAR(glm::dot(f.x, n), 0, 2e-6);
    ASSERT_LT(glm::distance(glm::cross(f.x, f.y), n), 4e-6f);
    const glm::vec3 w = random.in_box(1);
    ASSERT_LT(glm::distance(f.world(f.local(w)), w), 4e-6f);
  }
}

}  // namespace
}  // namespace likeness::ray
