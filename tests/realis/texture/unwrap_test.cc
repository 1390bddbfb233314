#include "realis/texture/unwrap.h"

#include <cmath>
#include <functional>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "realis/texture/sight.h"
#include "render/files/files.h"
#include "render/scene/mesh_file.h"

namespace likeness::realis {
namespace {

using testing::HasSubstr;

scene::Mesh mesh_of(const std::vector<glm::vec2>& uvs, const std::vector<std::array<scene::Index, 3>>& triangles) {
  scene::Mesh out;
  for (const glm::vec2& uv : uvs) out.positions.emplace_back(uv.x, 0, uv.y), out.uvs.push_back(uv);
  out.triangles = triangles;
  return out;
}

glm::vec2 uv_of(const scene::Mesh& mesh, const Unwrapped& u, std::size_t t) {
  const auto& i = mesh.triangles[u.triangles[t]];
  const glm::vec2 w = u.corners[t];
  return (1 - w.x - w.y) * mesh.uvs[i[0]] + w.x * mesh.uvs[i[1]] + w.y * mesh.uvs[i[2]];
}

TEST(Unwrap, EachTexelOfASquareBelongsToOneTriangleAndIsItsMiddle) {
  for (const int size : {1, 2, 7, 64}) {
    const scene::Mesh plane = scene::shape_mesh("plane", glm::dvec3(1), 1);
    const Unwrapped u = unwrap(plane, size, "plane");
    EXPECT_EQ(u.pixels.size(), static_cast<std::size_t>(size * size));
    EXPECT_EQ(u.inside, u.pixels.size());
    EXPECT_EQ(u.overlapping, 0u);
    for (std::size_t t = 0; t < u.pixels.size(); ++t) {
      const glm::vec2 at = static_cast<float>(size) * uv_of(plane, u, t);
      EXPECT_NEAR(at.x, static_cast<float>(u.pixels[t] % static_cast<std::uint32_t>(size)) + 0.5f, 1e-3);
      EXPECT_NEAR(at.y, static_cast<float>(u.pixels[t] / static_cast<std::uint32_t>(size)) + 0.5f, 1e-3);
    }
  }
}

// Fans and strips share edges and corners at all angles, also through middles of texels: each has one owner.
TEST(Unwrap, NeighboursShareNoTexel) {
  for (const int size : {16, 64, 96, 255}) {
    EXPECT_EQ(unwrap(scene::shape_mesh("disk", glm::dvec3(1), 64), size, "disk").overlapping, 0u);
    EXPECT_EQ(unwrap(scene::shape_mesh("faceted_sphere", glm::dvec3(1), 32), size, "ball").overlapping, 0u);
  }
}

// Wherever one looks on a triangle, the four texels about that place are there: no seam shows.
TEST(Unwrap, ABilinearLookMeetsOnlyTexelsThatAreThere) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(0.1f, 0.9f), share(0, 1);
  for (int round = 0; round < 50; ++round) {
    const scene::Mesh mesh = mesh_of(
        {{place(random), place(random)}, {place(random), place(random)}, {place(random), place(random)}}, {{0, 1, 2}});
    const int size = 40;
    const Unwrapped u = unwrap(mesh, size, "triangle");
    const std::set<std::uint32_t> there(u.pixels.begin(), u.pixels.end());
    for (int i = 0; i < 200; ++i) {
      float a = share(random), b = share(random);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      if (i < 60) b = 0;  // along an edge
      const glm::vec2 uv = (1 - a - b) * mesh.uvs[0] + a * mesh.uvs[1] + b * mesh.uvs[2];
      const int x = static_cast<int>(std::floor(uv.x * size - 0.5f)),
                y = static_cast<int>(std::floor(uv.y * size - 0.5f));
      for (const int dy : {0, 1})
        for (const int dx : {0, 1})
          EXPECT_TRUE(there.contains(static_cast<std::uint32_t>((y + dy) * size + x + dx))) << uv.x << ' ' << uv.y;
    }
    // And none is farther away than the gutter.
    for (std::size_t t = 0; t < u.pixels.size(); ++t) {
      const glm::vec2 at = static_cast<float>(size) * uv_of(mesh, u, t);
      const float dx = at.x - static_cast<float>(u.pixels[t] % 40) - 0.5f,
                  dy = at.y - static_cast<float>(u.pixels[t] / 40) - 0.5f;
      EXPECT_LE(std::hypot(dx, dy), kGutter + 0.02);
    }
  }
}

std::string refusal(const scene::Mesh& mesh) {
  try {
    unwrap(mesh, 32, "thing");
  } catch (const files::UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Unwrap, WhatHasNoTextureOfItsOwnIsRefused) {
  scene::Mesh none = mesh_of({{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}});
  none.uvs.clear();
  EXPECT_THAT(refusal(none), HasSubstr("object \"thing\" has no texture coordinates"));
  EXPECT_THAT(refusal(scene::shape_mesh("sphere", glm::dvec3(1), 1)), HasSubstr("has no triangles"));
  EXPECT_THAT(refusal(scene::Mesh{}), HasSubstr("has no triangles"));
  EXPECT_THAT(refusal(mesh_of({{0, 0}, {2, 0}, {0, 1}}, {{0, 1, 2}})), HasSubstr("outside [0, 1] (2, 0)"));
  // Mirrored halves on the same texels.
  EXPECT_THAT(refusal(mesh_of({{0, 0}, {1, 0}, {0, 1}, {1, 0}}, {{0, 1, 2}, {0, 2, 3}})), HasSubstr("more than once"));
  // Six sides of a box, each with the whole texture.
  EXPECT_THAT(refusal(scene::shape_mesh("box", glm::dvec3(1), 1)), HasSubstr("more than once"));
}

TEST(Unwrap, TrianglesWithoutAreaInTheTextureDoNoHarm) {
  const scene::Mesh mesh =
      mesh_of({{0.1f, 0.1f}, {0.9f, 0.1f}, {0.1f, 0.9f}, {0.5f, 0.5f}}, {{0, 1, 2}, {3, 3, 3}, {0, 1, 1}});
  const Unwrapped u = unwrap(mesh, 32, "thing");
  EXPECT_EQ(u.overlapping, 0u);
  EXPECT_GT(u.inside, 300u);
}

// A plate under a smaller one: a camera above sees the rim of the lower one only.
TEST(Sight, WhatStandsBetweenHidesATexel) {
  scene::Scene scene;
  scene.meshes = {scene::shape_mesh("plane", glm::dvec3(1), 1)};
  scene.materials.resize(1);
  glm::mat4 above(0.5f);
  above[3] = glm::vec4(0, 0.01f, 0, 1);
  scene.instances = {{"below", 0, 0, glm::mat4(1)}, {"above", 0, 0, above}};
  scene.cameras.resize(1);
  const world::World world(scene, plan::plan_of(scene, 0));
  const Unwrapped u = unwrap(scene.meshes[0], 32, "below");
  const TexelSurface surface = surface_of(world, 0, u);
  capture::Camera camera;
  camera.width = camera.height = 100;
  camera.intrinsics = glm::dmat3(800, 0, 0, 0, 800, 0, 50, 50, 1);
  camera.world_from_camera =
      glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, 1, 0), glm::dvec4(0, -1, 0, 0), glm::dvec4(0, 10, 0, 1));
  std::set<std::uint32_t> seen;
  for (const Seen& s : sight_of(world, 0, u, surface, camera).seen) seen.insert(s.texel);
  for (std::uint32_t t = 0; t < u.pixels.size(); ++t) {
    const glm::vec3 p = surface.positions[t];
    const float far = std::max(std::abs(p.x), std::abs(p.z));
    if (far > 0.27f) {
      EXPECT_TRUE(seen.contains(t)) << p.x << ' ' << p.z;
    }
    if (far < 0.23f) {
      EXPECT_FALSE(seen.contains(t)) << p.x << ' ' << p.z;
    }
  }
  // From below it is the back, and nothing is seen.
  camera.world_from_camera =
      glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, -1, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, -10, 0, 1));
  EXPECT_TRUE(sight_of(world, 0, u, surface, camera).seen.empty());
}

capture::Camera some_camera(bool is_orthographic) {
  capture::Camera c;
  c.width = 320, c.height = 200, c.is_orthographic = is_orthographic;
  c.intrinsics = glm::dmat3(300, 0, 0, 0, 310, 0, 150, 104, 1);
  const glm::dvec3 forward = glm::normalize(glm::dvec3(0.3, -0.2, 0.9));
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0))), down = glm::cross(forward, right);
  c.world_from_camera =
      glm::dmat4(glm::dvec4(right, 0), glm::dvec4(down, 0), glm::dvec4(forward, 0), glm::dvec4(0.1, 0.2, -1, 1));
  return c;
}

TEST(Projection, APointOnThePixelsRayIsInThatPixel) {
  for (const bool is_orthographic : {false, true}) {
    const Projection p(some_camera(is_orthographic));
    for (const auto& [x, y] : std::vector<std::pair<int, int>>{{0, 0}, {319, 199}, {17, 120}}) {
      const ray::Ray ray = p.ray(x, y);
      const Projection::Place place = p.of(glm::dvec3(ray.origin + 2.0f * ray.direction));
      EXPECT_NEAR(place.x, x + 0.5, 1e-3);  // rays are floats
      EXPECT_NEAR(place.y, y + 0.5, 1e-3);
      EXPECT_GT(place.depth, 0);
      EXPECT_NEAR(glm::dot(p.to_view(glm::dvec3(ray.origin + 2.0f * ray.direction)), glm::dvec3(ray.direction)), -1,
                  1e-6);
    }
  }
}

TEST(Projection, TheStepOfAPlaceIsTheDifferenceOfTwo) {
  for (const bool is_orthographic : {false, true}) {
    const Projection p(some_camera(is_orthographic));
    const glm::dvec3 at(0.2, 0.1, 0.5), step(0.3, -0.2, 0.7);
    constexpr double kSmall = 1e-6;
    const Projection::Place a = p.of(at - kSmall * step), b = p.of(at + kSmall * step);
    const auto moved = p.moved(at, step);
    EXPECT_NEAR(moved[0], (b.x - a.x) / (2 * kSmall), 1e-5);
    EXPECT_NEAR(moved[1], (b.y - a.y) / (2 * kSmall), 1e-5);
  }
}

}  // namespace
}  // namespace likeness::realis
