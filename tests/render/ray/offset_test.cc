#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "render/ray/frame.h"
#include "render/ray/offset.h"
#include "render/ray/tracer.h"
#include "render/sampling/sobol.h"

// Rays that leave a surface do not meet it again: a million of them, on large and small surfaces, near the origin and
// 10 km away from it.
namespace likeness::ray {
namespace {

struct Stream {
  std::uint32_t state = 1;
  float next() { return sampling::unit(state = sampling::mixed(state + 0x9e3779b9u)); }
  glm::vec3 direction() {
    const float z = 2 * next() - 1, phi = 6.2831853f * next(), s = std::sqrt(std::max(1 - z * z, 0.0f));
    return {s * std::cos(phi), s * std::sin(phi), z};
  }
};

// A direction above a normal, often at a very small angle to the surface.
glm::vec3 leaving(const glm::vec3& normal, Stream& random) {
  const float z = random.next() < 0.5f ? random.next() : std::pow(10.0f, -4 * random.next());
  const float phi = 6.2831853f * random.next(), s = std::sqrt(1 - z * z);
  return Frame(normal).world({s * std::cos(phi), s * std::sin(phi), z});
}

TEST(Offset, NoTriangleIsMetAgain) {
  Stream random;
  int tried = 0, met = 0;
  for (const float far : {0.0f, 1.0f, 100.0f, 10000.0f})
    for (const float size : {0.001f, 1.0f, 1000.0f})
      for (int t = 0; t < 40; ++t) {
        scene::Scene scene;
        scene::Mesh mesh;
        const glm::vec3 center = far * random.direction();
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(center + size * random.direction());
        mesh.triangles = {{0, 1, 2}};
        scene.meshes = {mesh};
        scene.materials.resize(1);
        scene.instances = {{"", 0, 0, glm::mat4(1)}};
        const Tracer tracer(scene, {});
        const glm::vec3 &a = mesh.positions[0], &b = mesh.positions[1], &c = mesh.positions[2];
        const glm::vec3 cross = glm::cross(b - a, c - a);
        if (!(glm::length(cross) > 0.05f * size * size)) continue;  // slivers: their normal is not known
        const glm::vec3 normal = glm::normalize(cross);
        for (int i = 0; i < 2100; ++i) {
          const float r = std::sqrt(random.next()), v = random.next() * r, u = r - v;
          const glm::vec3 point = (1 - u - v) * a + u * b + v * c;
          const glm::vec3 side = i % 2 ? normal : -normal;
          ++tried;
          if (tracer.occluded({beside(point, side), 0, leaving(side, random), kFar})) ++met;
        }
      }
  EXPECT_GT(tried, 800000);
  EXPECT_EQ(met, 0);
}

TEST(Offset, NoSphereIsMetAgainFromOutside) {
  Stream random;
  int tried = 0, met = 0, missed = 0;
  for (const float far : {0.0f, 1.0f, 100.0f, 10000.0f})
    for (const float radius : {0.01f, 1.0f, 1000.0f}) {
      if (radius < 1e-5f * far) continue;
      scene::Scene scene;
      scene.meshes.resize(1);
      scene.meshes[0].is_sphere = true;
      scene.materials.resize(1);
      const glm::vec3 center = far * random.direction();
      scene.instances = {{"", 0, 0, glm::scale(glm::translate(glm::mat4(1), center), glm::vec3(radius))}};
      const Tracer tracer(scene, {});
      for (int i = 0; i < 20000; ++i) {
        const glm::vec3 normal = random.direction(), point = center + radius * normal;
        ++tried;
        if (tracer.occluded({beside(point, normal), 0, leaving(normal, random), kFar})) ++met;
        // From within it must be met, on the other side.
        if (radius >= 0.05f * far && !tracer.occluded({beside(point, -normal), 0, leaving(-normal, random), kFar}))
          ++missed;
      }
    }
  EXPECT_GT(tried, 190000);
  EXPECT_EQ(met, 0);
  EXPECT_EQ(missed, 0);
}

TEST(Offset, IsNoFartherThanItSays) {
  Stream random;
  for (int i = 0; i < 100000; ++i) {
    const float size = std::pow(10.0f, 10 * random.next() - 6);
    const glm::vec3 p = size * random.direction(), n = random.direction(), q = beside(p, n);
    EXPECT_GE(glm::dot(glm::dvec3(q) - glm::dvec3(p), glm::dvec3(n)), 0);
    for (int k = 0; k < 3; ++k) {
      const float most = std::abs(p[k]) < 1.0f / 32 ? 1.0f / 65536 : 257 * std::abs(p[k]) * 0x1p-23f;
      ASSERT_LE(std::abs(q[k] - p[k]), most * 1.001f) << p[k];
    }
  }
}

}  // namespace
}  // namespace likeness::ray
