#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/render/scene/refusal.h"
#include "tests/render/scene/sound.h"

// glTF 2.0: what its parts become, and what is refused or put right.
namespace likeness::scene::test {
namespace {

using testing::HasSubstr;

std::string refusal_of(std::string_view from, std::string_view to) {
  return refusal_of_file("a.glb", small_glb(from, to));
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
  }
  return out;
}

TEST(Gltf, ReadsNodesMeshesMaterialsCamerasAndLights) {
  const Scene scene = scene_of_file("a.glb", small_glb());
  EXPECT_EQ(fault_of(scene), "");
  ASSERT_EQ(scene.instances.size(), 1u);
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.uvs[0], glm::vec2(0, 1));  // as the file has it: v runs down
  EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0));
  // Doubled by the leaf, then moved by the root.
  EXPECT_EQ(scene.instances[0].world_from_object * glm::vec4(1, 1, 0, 1), glm::vec4(2, 3, 0, 1));

  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].name, "eye");
  EXPECT_EQ(scene.cameras[0].width, 1024);
  EXPECT_NEAR(scene.cameras[0].focal_y, 256 / std::tan(0.45), 1e-9);
  EXPECT_EQ(scene.cameras[0].world_from_camera[3], glm::vec4(0, 0, 5, 1));
  const auto& spot = std::get<SpotLight>(scene.lights.at(0).shape);
  EXPECT_NEAR(spot.intensity.x, 1, 1e-6);  // 683 cd
  EXPECT_NEAR(spot.direction.z, 1, 1e-6);  // -z, turned by pi about x
  EXPECT_EQ(spot.outer, 0.5f);
}

TEST(Gltf, TurnsItsMaterialsIntoCallisto) {
  const Material m = scene_of_file("a.glb", small_glb()).materials.at(0);
  EXPECT_EQ(m.name, "paint");
  const auto& callisto = std::get<brdf::Callisto<double>>(m.brdf);
  EXPECT_EQ(callisto.base_color.g, 0.25);
  EXPECT_EQ(callisto.metallic, 0.5);
  EXPECT_EQ(callisto.roughness, 0.8);
  EXPECT_NEAR(callisto.specular, 0.5, 1e-12);  // ((1.5 - 1) / 2.5)^2 / 0.08
  ASSERT_EQ(m.bindings.size(), 3u);
  const auto of = [&](std::string_view name) {
    for (const auto& binding : m.bindings)
      if (brdf::Callisto<double>::kParameters[binding.parameter].name == name) return binding.texture;
    return Texture{};
  };
  EXPECT_EQ(of("base_color").transfer, Transfer::kSrgb);
  EXPECT_EQ(of("base_color").scale, glm::vec3(0.5f, 0.25f, 1));
  EXPECT_EQ(of("base_color").wrap, Wrap::kClamp);
  EXPECT_EQ(of("roughness").channel, 1);
  EXPECT_EQ(of("roughness").scale.x, 0.8f);
  EXPECT_EQ(of("metallic").channel, 2);
  EXPECT_EQ(of("metallic").transfer, Transfer::kLinear);
  EXPECT_EQ(m.normal_strength, 0.5f);
  ASSERT_TRUE(m.opacity);
  EXPECT_EQ(m.opacity->channel, 3);
  EXPECT_EQ(m.opacity->scale.x, 0.75f);
  EXPECT_EQ(m.opacity_cutoff, 0.25f);
  EXPECT_NEAR(m.emission.y, 0.5 / 683, 1e-9);
  EXPECT_TRUE(m.two_sided);
}

TEST(Gltf, ReadsTextFilesWithBuffersBesideAndWithinThem) {
  Files files = small_files();
  files["a b.bin"] = square_bytes();
  files["a.gltf"] = square_json("\"byteLength\": 140", "\"byteLength\": 140, \"uri\": \"a%20b.bin\"");
  EXPECT_EQ(scene_of_mesh("a.gltf", access_of(files)).meshes.at(0).triangles.size(), 2u);
  files["a.gltf"] =
      square_json("\"byteLength\": 140", "\"byteLength\": 140, \"uri\": \"data:application/octet-stream;base64," +
                                             base64(square_bytes()) + "\"");
  EXPECT_EQ(scene_of_mesh("a.gltf", access_of(files)).meshes.at(0).positions,
            scene_of_file("a.glb", small_glb()).meshes.at(0).positions);
  EXPECT_THAT(refusal_of_file("a.gltf", square_json()),
              HasSubstr("/buffers/0 has no uri, and there is no binary chunk"));
  EXPECT_THAT(refusal_of_file("a.gltf",
                              square_json("\"byteLength\": 140", "\"byteLength\": 3, \"uri\": \"data:;base64,AA!A\"")),
              HasSubstr("which is not base64"));
}

TEST(Gltf, ANodeThatIsReachedTwiceIsNamed) {
  EXPECT_THAT(refusal_of("\"children\": [1]", "\"children\": [0]"),
              HasSubstr("/nodes/0/children/0 reaches node 0 \"root\" a second time; nodes must form a tree"));
  EXPECT_THAT(refusal_of("\"children\": [1]", "\"children\": [1, 1]"),
              HasSubstr("reaches node 1 \"leaf\" a second time"));
  EXPECT_THAT(refusal_of("\"nodes\": [0, 2, 3]", "\"nodes\": [0, 2, 3, 1]"), HasSubstr("a second time"));
}

TEST(Gltf, ALongChainOfNodesNeedsNoStack) {
  std::string chain;
  constexpr int kLength = 200'000;  // deep enough to end a recursive reader, which takes some 100 bytes a level or more
  for (int i = 0; i < kLength; ++i) chain += "{\"children\": [" + std::to_string(i + 4 + 1) + "]}, ";
  const std::string text = square_json("\"camera\": 0, \"translation\": [0, 0, 5]}",
                                       "\"camera\": 0, \"translation\": [0, 0, 5], \"children\": [4]}");
  std::string deep = text;
  const std::string end = "\"rotation\": [1, 0, 0, 0]}]";
  deep.replace(deep.find(end), end.size(), "\"rotation\": [1, 0, 0, 0]}, " + chain + "{}]");
  EXPECT_EQ(scene_of_file("a.glb", glb(deep, square_bytes())).instances.size(), 1u);
}

TEST(Gltf, EveryIndexIsChecked) {
  EXPECT_THAT(refusal_of("\"mesh\": 0", "\"mesh\": 7"),
              HasSubstr("a.glb:2: /nodes/1/mesh names /meshes/7, but there are 1"));
  EXPECT_THAT(refusal_of("\"children\": [1]", "\"children\": [-1]"), HasSubstr("expected the index of a node"));
  EXPECT_THAT(refusal_of("\"children\": [1]", "\"children\": [99]"), HasSubstr("names /nodes/99, but there are 4"));
  EXPECT_THAT(refusal_of("\"scene\": 0", "\"scene\": 3"), HasSubstr("/scene names /scenes/3"));
  EXPECT_THAT(refusal_of("\"camera\": 0", "\"camera\": 1"), HasSubstr("names /cameras/1"));
  EXPECT_THAT(
      refusal_of("\"light\": 0", "\"light\": 5"),
      HasSubstr(
          "/nodes/3/extensions/KHR_lights_punctual names /extensions/KHR_lights_punctual/lights/5, but there are 1"));
  EXPECT_THAT(refusal_of("\"material\": 0", "\"material\": 2"), HasSubstr("names /materials/2"));
  EXPECT_THAT(refusal_of("\"index\": 0", "\"index\": 9"), HasSubstr("names /textures/9"));
  EXPECT_THAT(refusal_of("\"source\": 0", "\"source\": 9"), HasSubstr("names /images/9"));
  EXPECT_THAT(refusal_of("\"sampler\": 0", "\"sampler\": 9"), HasSubstr("names /samplers/9"));
  EXPECT_THAT(refusal_of("\"POSITION\": 1", "\"POSITION\": 9"), HasSubstr("names /accessors/9"));
  EXPECT_THAT(refusal_of("\"indices\": 0", "\"indices\": 1"), HasSubstr("expected SCALAR of unsigned integers"));
  EXPECT_THAT(refusal_of("\"bufferView\": 1", "\"bufferView\": 4"), HasSubstr("names /bufferViews/4"));
  EXPECT_THAT(refusal_of("\"buffer\": 0", "\"buffer\": 1"), HasSubstr("/bufferViews/0/buffer = 1, but there are 1"));
  EXPECT_THAT(refusal_of("\"mesh\": 0", "\"mesh\": 0.5"), HasSubstr("expected a whole number that is not negative"));
  std::string bytes = square_bytes();
  bytes[10] = 4;  // the last index
  EXPECT_THAT(refusal_of_file("a.glb", glb(square_json(), bytes)),
              HasSubstr("/indices names vertex 4, but there are 4"));
}

TEST(Gltf, EveryCountAndOffsetIsChecked) {
  EXPECT_THAT(refusal_of("\"count\": 6", "\"count\": 7"),
              HasSubstr("/accessors/0 has 7 elements of 2 bytes from byte 0, but its view has 12 bytes"));
  EXPECT_THAT(refusal_of("\"count\": 6", "\"count\": 8000000000000000"), HasSubstr("elements of 2 bytes"));
  EXPECT_THAT(refusal_of("\"count\": 6", "\"byteOffset\": 9007199254740991, \"count\": 6"), HasSubstr("is the number"));
  EXPECT_THAT(refusal_of("\"count\": 6", "\"byteOffset\": 8000000000000000, \"count\": 6"),
              HasSubstr("its view has 12 bytes"));
  EXPECT_THAT(refusal_of("\"byteOffset\": 108, \"byteLength\": 32", "\"byteOffset\": 108, \"byteLength\": 33"),
              HasSubstr("/bufferViews/3 spans bytes 108 to 141 of a buffer of 140"));
  EXPECT_THAT(refusal_of("\"byteLength\": 140", "\"byteLength\": 141"),
              HasSubstr("/buffers/0/byteLength = 141; its file holds 140"));
  EXPECT_THAT(
      refusal_of("\"byteOffset\": 12, \"byteLength\": 48", "\"byteOffset\": 12, \"byteLength\": 48, \"byteStride\": 4"),
      HasSubstr("/byteStride = 4; expected 12 to 252"));
  EXPECT_THAT(refusal_of("{\"bufferView\": 2, \"componentType\": 5126, \"count\": 4",
                         "{\"bufferView\": 2, \"componentType\": 5126, \"count\": 3"),
              HasSubstr("NORMAL has 3 values, but there are 4 positions"));
  EXPECT_THAT(refusal_of("5123", "5130"), HasSubstr("/componentType = 5130 is none of glTF 2.0"));
  EXPECT_THAT(refusal_of("\"SCALAR\"", "\"MAT4\""), HasSubstr("expected SCALAR, VEC2, VEC3 or VEC4"));
  EXPECT_THAT(refusal_of("\"count\": 6", "\"sparse\": {}, \"count\": 6"), HasSubstr("sparse accessors are not read"));
}

TEST(Gltf, ReadsQuantizedAndStridedValues) {
  // Positions as normalized shorts, 8 bytes apart.
  std::string bytes = square_bytes();
  for (const int x : {0, 0, 0, 0, 32767, 0, 0, 0, 32767, 32767, 0, 0, 0, 32767, 0, 0})
    put(bytes, static_cast<std::int16_t>(x));
  std::string text = square_json("{\"bufferView\": 1, \"componentType\": 5126",
                                 "{\"bufferView\": 4, \"normalized\": true, \"componentType\": 5122");
  const std::string end = "\"byteOffset\": 108, \"byteLength\": 32}";
  text.replace(text.find(end), end.size(),
               end + ", {\"buffer\": 0, \"byteOffset\": 140, \"byteLength\": 32, \"byteStride\": 8}");
  const std::string size = "[{\"byteLength\": 140}]";
  text.replace(text.find(size), size.size(), "[{\"byteLength\": 172}]");
  const Mesh mesh = scene_of_file("a.glb", glb(text, bytes)).meshes.at(0);
  EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0));
  EXPECT_EQ(mesh.positions[1], glm::vec3(1, 0, 0));
}

TEST(Gltf, StripsAndFansAreTrianglesAndLinesAreLeftOut) {
  EXPECT_EQ(scene_of_file("a.glb", small_glb("\"indices\": 0", "\"mode\": 5")).meshes.at(0).triangles,
            (std::vector<std::array<Index, 3>>{{0, 1, 2}, {2, 1, 3}}));
  EXPECT_EQ(scene_of_file("a.glb", small_glb("\"indices\": 0", "\"mode\": 6")).meshes.at(0).triangles,
            (std::vector<std::array<Index, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_THAT(refusal_of("\"indices\": 0", "\"mode\": 1"), HasSubstr("shows no triangles; expected a mesh"));
}

TEST(Gltf, WhatItCannotShowIsCounted) {
  EXPECT_EQ(count_of(scene_of_file("a.glb", small_glb("\"alphaMode\"",
                                                      "\"extensions\": {\"KHR_materials_unlit\": {}}, \"alphaMode\"")),
                     "unlit"),
            1u);
  EXPECT_EQ(count_of(scene_of_file("a.glb", small_glb("MASK", "BLEND")), "blended alpha"), 1u);
  EXPECT_EQ(
      count_of(scene_of_file("a.glb", small_glb("\"scale\": [2, 2, 2]", "\"scale\": [2, 0, 2]")), "nodes make flat"),
      1u);
  EXPECT_EQ(count_of(scene_of_file("a.glb", small_glb("33071", "33648")), "mirrored or mixed"), 3u);
  EXPECT_EQ(count_of(scene_of_file("a.glb", small_glb("\"roughnessFactor\": 0.8", "\"roughnessFactor\": 8")),
                     "brought into their range"),
            1u);
  EXPECT_EQ(count_of(scene_of_file("a.glb", small_glb(", \"TEXCOORD_0\": 3", "")), "without texture coordinates"), 1u);
  const Scene bare = scene_of_file("a.glb", small_glb(", \"TEXCOORD_0\": 3", ""));
  EXPECT_EQ(fault_of(bare), "");
  EXPECT_FALSE(bare.materials.at(0).normal_map);
}

TEST(Gltf, AHostileRootIsRefusedAtOnce) {
  std::string junk;
  for (int i = 0; i < 300; ++i) junk += "\"k" + std::to_string(i) + "\": 0, ";
  EXPECT_THAT(refusal_of("\"asset\"", junk + "\"asset\""),
              HasSubstr("the file has 314 members; expected a glTF 2.0 file"));
}

TEST(Gltf, ExtensionsThatItNeedsAndWeDoNotReadAreNamed) {
  EXPECT_THAT(refusal_of("\"asset\"", "\"extensionsRequired\": [\"KHR_draco_mesh_compression\"], \"asset\""),
              HasSubstr("/extensionsRequired/0 = \"KHR_draco_mesh_compression\" is not read by this program"));
  EXPECT_EQ(refusal_of("\"asset\"", "\"extensionsRequired\": [\"KHR_texture_transform\"], \"asset\""), "");
  EXPECT_THAT(refusal_of("\"2.0\"", "\"1.0\""), HasSubstr("/asset/version = \"1.0\""));
}

TEST(Gltf, ReadsTextureTransformsAndStrengths) {
  const Scene scene =
      scene_of_file("a.glb", small_glb("\"baseColorTexture\": {\"index\": 0}",
                                       "\"baseColorTexture\": {\"index\": 0, \"extensions\": "
                                       "{\"KHR_texture_transform\": {\"scale\": [2, 3], \"offset\": [0.5, 0.25]}}}"));
  EXPECT_EQ(scene.materials.at(0).bindings.at(0).texture.uv_scale, glm::vec2(2, 3));
  const Material bright =
      scene_of_file("a.glb", small_glb("\"emissiveFactor\"",
                                       "\"extensions\": {\"KHR_materials_emissive_strength\": {\"emissiveStrength\": "
                                       "683}, \"KHR_materials_ior\": {\"ior\": 1.2}}, \"emissiveFactor\""))
          .materials.at(0);
  EXPECT_NEAR(bright.emission.x, 1, 1e-6);
  EXPECT_NEAR(std::get<brdf::Callisto<double>>(bright.brdf).specular, std::pow(0.2 / 2.2, 2) / 0.08, 1e-12);
}

TEST(Gltf, ADamagedContainerIsOneLine) {
  const std::string whole = small_glb();
  for (std::size_t size = 0; size < whole.size(); ++size)
    ASSERT_THAT(refusal_of_file("a.glb", whole.substr(0, size)), testing::StartsWith("a.glb:")) << size;
  EXPECT_THAT(refusal_of_file("a.glb", "glTF\3" + whole.substr(5)), HasSubstr("is version 3 of the container"));
  EXPECT_THAT(refusal_of("\"images\": [{\"uri\": \"paint.png\"}]", "\"images\": [{\"uri\": \"/etc/passwd\"}]"),
              HasSubstr("expected the name of a file beside this one"));
}

}  // namespace
}  // namespace likeness::scene::test
