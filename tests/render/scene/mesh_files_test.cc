#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/render/scene/refusal.h"
#include "tests/render/scene/sound.h"

// OBJ, its materials, PLY, and the shapes that need no file.
namespace likeness::scene::test {
namespace {

using testing::HasSubstr;

TEST(Obj, AMaterialIsAMeshAndACornerAVertex) {
  const Scene scene = scene_of_file("a.obj", small_obj());
  EXPECT_EQ(fault_of(scene), "");
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[0].positions.size(), 4u);
  EXPECT_EQ(scene.meshes[0].triangles, (std::vector<std::array<Index, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(scene.meshes[0].uvs[0], glm::vec2(0, 1));  // the bottom row, where v is 1 here
  EXPECT_EQ(scene.meshes[0].normals[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.meshes[1].positions[2], glm::vec3(0, 0, 2));
}

TEST(Obj, ItsLibraryGivesColorAndRoughness) {
  const Scene scene = scene_of_file("a.obj", small_obj());
  ASSERT_EQ(scene.materials.size(), 2u);
  const auto& red = std::get<brdf::Callisto<double>>(scene.materials[0].brdf);
  EXPECT_EQ(red.base_color.r, 0.8);
  EXPECT_EQ(red.roughness, 0.3);
  const auto& blue = std::get<brdf::Callisto<double>>(scene.materials[1].brdf);
  EXPECT_NEAR(blue.roughness, std::pow(0.02, 0.25), 1e-12);  // Ns 98: alpha^2 = 2 / 100
  // It has no texture coordinates, so its picture is left out, and that is counted.
  EXPECT_TRUE(scene.materials[1].bindings.empty());
  EXPECT_EQ(count_of(scene, "without texture coordinates"), 1u);
}

TEST(Obj, OptionsOfAPictureAreNotItsName) {
  std::string obj = small_obj();
  obj.replace(obj.find("-5//1 -4//1 -1//1"), 17, "1/1/1 2/2/1 5/3/1");
  const Scene scene = scene_of_file("a.obj", obj);
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.images[0].name, "paint.png");
  EXPECT_EQ(scene.materials[1].bindings.size(), 1u);
}

TEST(Obj, AMissingLibraryIsCounted) {
  const Scene scene = scene_of_file("a.obj", "mtllib none.mtl\nusemtl x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(count_of(scene, "libraries that cannot be read"), 1u);
  EXPECT_EQ(scene.materials.at(0).name, "default");
}

TEST(Obj, RefusesWithTheLine) {
  EXPECT_THAT(refusal_of_file("a.obj", "v 0 0 0\nv 1 0 x\n"),
              HasSubstr("a.obj:2: \"v\" has the word \"x\"; expected 3 numbers"));
  EXPECT_THAT(refusal_of_file("a.obj", "v 0 0 0\nf 1 2 3\n"),
              HasSubstr("a.obj:2: the corner \"2\" names no position; there are 1 before it"));
  EXPECT_THAT(refusal_of_file("a.obj", "v 0 0 0\nf 0 1 1\n"), HasSubstr("names no position"));
  EXPECT_THAT(refusal_of_file("a.obj", "v 0 0 0\nf -2 1 1\n"), HasSubstr("names no position"));
  EXPECT_THAT(refusal_of_file("a.obj", "v 0 0 0\nf 1/2 1 1\n"), HasSubstr("names no texture coordinate"));
  EXPECT_THAT(refusal_of_file("a.obj", "v 0 0 0\nf 1//9 1 1\n"), HasSubstr("names no normal"));
  EXPECT_THAT(refusal_of_file("a.obj", "v 0 0 0\nf 1x 1 1\n"), HasSubstr("is not of the form 7/1/3"));
  EXPECT_THAT(refusal_of_file("a.obj", "v 0 0 0\nf 1 1\n"), HasSubstr("a face has 2 corners"));
  EXPECT_THAT(refusal_of_file("a.obj", "v 0 0 0\nf 99999999999999999999 1 1\n"), HasSubstr("names no position"));
  EXPECT_THAT(refusal_of_file("a.obj", "# nothing\n"), HasSubstr("has no faces"));
}

TEST(Obj, APartIsTakenByItsName) {
  const Scene scene = scene_of_members(
      "\"meshes\": {\"m\": {\"file\": \"square.obj\", \"part\": \"corner\"}}, \"instances\": [{\"mesh\": \"m\"}]");
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].triangles.size(), 1u);
}

TEST(Obj, MaterialsOfTheFileAreExchangedByName) {
  const Scene scene = scene_of_members(
      "\"meshes\": {\"m\": {\"file\": \"square.obj\"}}, \"materials\": {\"gold\": {\"model\": \"ggx\"}}, "
      "\"instances\": [{\"mesh\": \"m\", \"materials\": {\"red\": \"gold\"}}]");
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.materials[scene.instances[0].material].name, "gold");
  EXPECT_EQ(scene.materials[scene.instances[1].material].name, "blue");
  EXPECT_EQ(scene.instances[0].name, "m/red");
}

TEST(Ply, TextIsReadWithTextureCoordinatesAndPolygons) {
  const Scene scene = scene_of_file("a.ply", small_ply());
  EXPECT_EQ(fault_of(scene), "");
  EXPECT_EQ(scene.meshes.at(0).triangles, (std::vector<std::array<Index, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(scene.meshes[0].uvs[3], glm::vec2(0, 0));  // t = 1 is the top row
}

TEST(Ply, BinaryOfEitherEndAndOfEveryTypeIsTheSame) {
  const Mesh little = scene_of_file("a.ply", small_binary_ply()).meshes.at(0);
  EXPECT_EQ(little.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(little.triangles.size(), 1u);
  // The same with its numbers turned round.
  std::string big = small_binary_ply();
  big.replace(big.find("little"), 6, "big");
  auto at = big.begin() + static_cast<std::ptrdiff_t>(big.find("end_header\n") + 11);
  for (int vertex = 0; vertex < 3; ++vertex)
    for (const int size : {8, 4, 4, 1}) {
      std::reverse(at, at + size);
      at += size;
    }
  for (const int size : {1, 4, 4, 4, 4}) {
    std::reverse(at, at + size);
    at += size;
  }
  ASSERT_EQ(at, big.end());
  const Mesh mesh = scene_of_file("a.ply", big).meshes.at(0);
  EXPECT_EQ(mesh.positions, little.positions);
  EXPECT_EQ(mesh.triangles, little.triangles);
}

TEST(Ply, RefusesWithTheReason) {
  const auto said = [](std::string_view from, std::string_view to) {
    std::string text = small_ply();
    text.replace(text.find(from), from.size(), to);
    return refusal_of_file("a.ply", text);
  };
  EXPECT_THAT(said("ply\n", "plx\n"), HasSubstr("a.ply:1: does not begin with \"ply\""));
  EXPECT_THAT(said("ascii", "utf8"), HasSubstr("a.ply:2: the format is \"utf8\""));
  EXPECT_THAT(said("vertex 4", "vertex 4000000000"), HasSubstr("ends before its 4000000000 elements \"vertex\""));
  EXPECT_THAT(said("vertex 4", "vertex -1"), HasSubstr("has no count"));
  EXPECT_THAT(said("face 1\n", "face 2\n"), HasSubstr("ends within its elements \"face\""));
  EXPECT_THAT(said("4 0 1 2 3", "4 0 1 2 4"), HasSubstr("a face names vertex 4, but there are 4"));
  EXPECT_THAT(said("4 0 1 2 3", "4 0 1 2 -3"), HasSubstr("vertices count from 0"));
  EXPECT_THAT(said("4 0 1 2 3", "900000 0 1 2 3"), HasSubstr("a list has 900000 entries, more than the file holds"));
  EXPECT_THAT(said("1 1 0 1 1", "1 one 0 1 1"), HasSubstr("a.ply:15: has the word \"one\"; expected a number"));
  EXPECT_THAT(said("property float z", "property float w"), HasSubstr("vertices have no x, y and z"));
  EXPECT_THAT(said("vertex_indices", "edges"), HasSubstr("has no element \"face\" with a list"));
  EXPECT_THAT(said("list uchar int", "list float int"), HasSubstr("expected an integer type"));
}

TEST(Shapes, AreSoundAndFaceOutwards) {
  for (const std::string shape : {"plane", "box", "disk", "faceted_sphere"}) {
    const Scene scene = scene_of_members("\"meshes\": {\"m\": {\"shape\": \"" + shape +
                                         "\", \"segments\": 16}}, \"instances\": [{\"mesh\": \"m\"}]");
    EXPECT_EQ(fault_of(scene), "") << shape;
    EXPECT_EQ(count_of(scene, "left out"), 0u) << shape;
    const Mesh& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    for (const auto& [a, b, c] : mesh.triangles) {
      const glm::vec3 u = mesh.positions[b] - mesh.positions[a], v = mesh.positions[c] - mesh.positions[a];
      const glm::vec3 n = glm::cross(u, v);
      EXPECT_GT(glm::dot(n, mesh.normals[a] + mesh.normals[b] + mesh.normals[c]), 0) << shape;
      const bool is_closed = shape == "box" || shape == "faceted_sphere";
      EXPECT_GT(glm::dot(n, is_closed ? mesh.positions[a] + mesh.positions[b] : glm::vec3(0, 1, 0)), 0) << shape;
      // Where the texture is not squeezed to a point, tangents go along u, and cross(n, t) w against v.
      const glm::vec2 p = mesh.uvs[b] - mesh.uvs[a], q = mesh.uvs[c] - mesh.uvs[a];
      const float area = p.x * q.y - q.x * p.y;
      ASSERT_NE(area, 0) << shape;
      const glm::vec3 along = (u * q.y - v * p.y) / area, down = (v * p.x - u * q.x) / area;
      const glm::vec3 normal = glm::normalize(n);
      for (const Index i : {a, b, c}) {
        if (shape == "faceted_sphere" && std::abs(mesh.positions[i].y) > 0.9f) continue;  // a pole has every direction
        EXPECT_GT(glm::dot(along, glm::vec3(mesh.tangents[i])), 0.5f * glm::length(along)) << shape;
        EXPECT_LT(glm::dot(down, glm::cross(normal, glm::vec3(mesh.tangents[i])) * mesh.tangents[i].w),
                  -0.5f * glm::length(down))
            << shape;
      }
    }
  }
  EXPECT_TRUE(scene_of_members("\"meshes\": {\"m\": {\"shape\": \"sphere\"}}, \"instances\": [{\"mesh\": \"m\"}]")
                  .meshes.at(0)
                  .is_sphere);
}

TEST(Shapes, HaveTheSizeThatIsAskedFor) {
  const Scene scene = scene_of_members(
      "\"meshes\": {\"m\": {\"shape\": \"box\", \"size\": [1, 2, 4]}}, \"instances\": [{\"mesh\": \"m\"}]");
  EXPECT_EQ(bounds(scene).high, glm::vec3(0.5f, 1, 2));
  EXPECT_EQ(bounds(scene).low, glm::vec3(-0.5f, -1, -2));
  EXPECT_EQ(scene.meshes[0].triangles.size(), 12u);
}

}  // namespace
}  // namespace likeness::scene::test
