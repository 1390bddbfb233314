#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/scene/mend.h"
#include "tests/render/scene/refusal.h"
#include "tests/render/scene/sound.h"

// What is wrong with a mesh is put right and counted, and nothing else is touched.
namespace likeness::scene::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Mended {
  Mesh mesh;
  Scene scene;
};
Mended mended(Mesh mesh, Normals normals = Normals::kFile, bool has_map = false) {
  Mended out;
  const Files files;
  const Access access = access_of(files);
  Loading loading(out.scene, access);
  mend(mesh, normals, "a", loading);
  if (has_map) make_tangents(mesh, "a", loading);
  out.mesh = std::move(mesh);
  return out;
}

// A square in the plane z = 0, facing +z, with v downwards, and its normals.
Mesh square() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(Mend, ASoundMeshIsAsItWas) {
  const Mended out = mended(square());
  EXPECT_TRUE(out.scene.repairs.empty());
  EXPECT_EQ(out.mesh.positions, square().positions);
  EXPECT_EQ(out.mesh.normals, square().normals);
  EXPECT_EQ(out.mesh.triangles, square().triangles);
}

TEST(Mend, TrianglesWithoutAreaAreLeftOutAndCounted) {
  Mesh mesh = square();
  mesh.positions.push_back({0.5f, 0, 0});
  mesh.normals.push_back({0, 0, 1});
  mesh.uvs.push_back({0.5f, 1});
  mesh.triangles.push_back({0, 4, 1});  // on a line
  mesh.triangles.push_back({1, 1, 2});
  mesh.triangles.push_back({0, 1, 77});
  const Mended out = mended(mesh);
  EXPECT_EQ(out.mesh.triangles.size(), 2u);
  EXPECT_EQ(count_of(out.scene, "without area"), 1u);
  EXPECT_EQ(count_of(out.scene, "repeated or absent corner"), 2u);
}

TEST(Mend, ASliverThatFloatsCanTellIsKept) {
  Mesh mesh = square();
  mesh.positions[2] = {0.5f, 1e-6f, 0};
  EXPECT_EQ(mended(mesh).mesh.triangles.size(), 2u);
  mesh.positions = {{0, 0, 0}, {1e-6f, 0, 0}, {1e-6f, 1e-6f, 0}, {0, 1e-6f, 0}};  // small is not thin
  EXPECT_EQ(mended(mesh).mesh.triangles.size(), 2u);
}

TEST(Mend, VerticesThatAreNoNumbersTakeTheirTrianglesWithThem) {
  for (const float bad : {kNaN, std::numeric_limits<float>::infinity(), 2e9f}) {
    Mesh mesh = square();
    mesh.positions[3].y = bad;
    const Mended out = mended(mesh);
    EXPECT_EQ(out.mesh.triangles.size(), 1u);
    EXPECT_EQ(count_of(out.scene, "triangles with a corner that is no number"), 1u);
    EXPECT_EQ(count_of(out.scene, "vertices that are no numbers"), 1u);
    EXPECT_EQ(fault_of(out.mesh), "");
  }
}

TEST(Mend, NormalsWithoutDirectionAreThoseOfTheirTriangles) {
  Mesh mesh = square();
  mesh.normals[1] = {0, 0, 0};
  mesh.normals[2] = {kNaN, 0, 1};
  mesh.normals[3] = {0, 0, 5};
  const Mended out = mended(mesh);
  EXPECT_EQ(count_of(out.scene, "normals without a direction"), 2u);
  for (const glm::vec3& n : out.mesh.normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
}

TEST(Mend, SmoothNormalsAreWeightedByAngle) {
  // The corner of a cube, one side of it cut in two: the cut must not count double.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5f, 0.5f, 0}};
  mesh.triangles = {{0, 2, 4}, {0, 4, 1}, {0, 3, 2}, {0, 1, 3}};
  const glm::vec3 normal = mended(mesh, Normals::kSmooth).mesh.normals[0];
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(normal[c], -1 / std::sqrt(3.0f), 1e-6);
  EXPECT_TRUE(mended(square(), Normals::kFlat).mesh.normals.empty());
}

TEST(Mend, TextureCoordinatesThatAreNoNumbersAreZero) {
  Mesh mesh = square();
  mesh.uvs[2].x = kNaN;
  mesh.uvs[3].y = 1e30f;
  const Mended out = mended(mesh);
  EXPECT_EQ(out.mesh.uvs[2], glm::vec2(0));
  EXPECT_EQ(count_of(out.scene, "texture coordinates that are no numbers"), 2u);
}

TEST(Mend, TangentsRunAlongUWithVUpwardsOnTheirSide) {
  const Mesh straight = mended(square(), Normals::kFile, true).mesh;
  for (const glm::vec4& t : straight.tangents) EXPECT_EQ(t, glm::vec4(1, 0, 0, 1));
  Mesh mesh = square();
  for (glm::vec2& uv : mesh.uvs) uv.x = -uv.x;
  for (const glm::vec4& t : mended(mesh, Normals::kFile, true).mesh.tangents) EXPECT_EQ(t, glm::vec4(-1, 0, 0, -1));
  mesh = square();
  flip_v(mesh);
  EXPECT_EQ(mesh.uvs[0], glm::vec2(0, 0));
  for (const glm::vec4& t : mended(mesh, Normals::kFile, true).mesh.tangents) EXPECT_EQ(t, glm::vec4(1, 0, 0, -1));
  mesh = square();
  mesh.normals.assign(4, {0, 0, -1});  // against the order of the corners
  for (const glm::vec4& t : mended(mesh, Normals::kFile, true).mesh.tangents) EXPECT_EQ(t, glm::vec4(1, 0, 0, -1));
}

TEST(Mend, TangentsAreSquareToTheNormals) {
  Mesh mesh = square();
  mesh.normals.assign(4, glm::normalize(glm::vec3(1, 0.5f, 1)));
  for (const glm::vec4& t : mended(mesh, Normals::kFile, true).mesh.tangents) {
    EXPECT_NEAR(glm::dot(glm::vec3(t), mesh.normals[0]), 0, 1e-6);
    EXPECT_NEAR(glm::length(glm::vec3(t)), 1, 1e-6);
    EXPECT_GT(t.x, 0);
  }
}

TEST(Mend, WhereUHasNoDirectionATangentIsMadeUpAndCounted) {
  Mesh mesh = square();
  mesh.uvs.assign(4, {0.5f, 0.5f});
  const Mended out = mended(mesh, Normals::kFile, true);
  EXPECT_EQ(count_of(out.scene, "tangents where u has no direction"), 4u);
  EXPECT_EQ(fault_of(out.mesh), "");
}

TEST(Mend, TangentsOfTheFileAreMadeUnitOrLeftOut) {
  Mesh mesh = square();
  mesh.tangents.assign(4, {2, 0, 1, 0.5f});
  for (const glm::vec4& t : mended(mesh).mesh.tangents) EXPECT_EQ(t, glm::vec4(1, 0, 0, 1));
  mesh.tangents[2] = {0, 0, 1, 1};  // along the normal
  const Mended out = mended(mesh);
  EXPECT_TRUE(out.mesh.tangents.empty());
  EXPECT_EQ(count_of(out.scene, "tangents without a direction"), 1u);
}

}  // namespace
}  // namespace likeness::scene::test
