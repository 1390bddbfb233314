#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "render/files/files.h"
#include "render/scene/ies.h"
#include "render/scene/read_scene.h"
#include "tests/render/scene/sound.h"

// Files as people made them; they lie beside the checkout.
namespace likeness::scene::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kShared = LIKENESS_SHARED_DIR "/data";

bool has(const char* file) { return fs::exists(kShared / file); }
constexpr const char* kNoData = "the shared data are not there";

// Pictures are not what these tests are about.
Access access_without_pictures() {
  const auto texels = [](const auto&...) { return image::Texels{1, 1, 3, {128, 128, 255}, {}}; };
  return {[](const fs::path& file, std::size_t limit) { return likeness::files::read_whole(file, limit); }, texels,
          texels};
}

Scene scene_with(const std::string& members) {
  return scene_of("{\"format\": \"likeness scene\", \"version\": 1, " + members + "}", "room.json", kShared,
                  access_without_pictures());
}

TEST(SharedData, TheHeadStandsUprightWithItsTextureAndTangents) {
  if (!has("heads/lee-perry-smith/LeePerrySmith.glb"))
    GTEST_SKIP() << kNoData << ": heads/lee-perry-smith/LeePerrySmith.glb";
  const Scene scene = scene_with(
      "\"meshes\": {\"head\": {\"file\": \"heads/lee-perry-smith/LeePerrySmith.glb\", \"flip_v\": true}}, "
      "\"materials\": {\"skin\": {\"normal_map\": {\"file\": "
      "\"heads/lee-perry-smith/Infinite-Level_02_Tangent_SmoothUV.jpg\"}}}, "
      "\"instances\": [{\"mesh\": \"head\", \"material\": \"skin\"}]");
  EXPECT_EQ(fault_of(scene), "");
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.positions.size(), 9279u);
  EXPECT_EQ(mesh.triangles.size(), 17684u);
  EXPECT_EQ(mesh.tangents.size(), 9279u);
  EXPECT_NEAR(bounds(scene).high.y, 3.97255, 1e-4);
  // The picture's top row is the crown: on the whole v falls as y rises.
  double sum = 0;
  std::size_t mirrored = 0;
  for (std::size_t i = 0; i < mesh.uvs.size(); ++i) {
    sum += (static_cast<double>(mesh.uvs[i].y) - 0.5) * static_cast<double>(mesh.positions[i].y);
    mirrored += mesh.tangents[i].w < 0;
  }
  EXPECT_LT(sum, 0);
  EXPECT_EQ(mirrored, 432u);  // of 9279: where its texture is folded over (counted from the file by hand too)
}

TEST(SharedData, TheBunnyAndSpotAreWhole) {
  if (!has("meshes/stanford-bunny.obj")) GTEST_SKIP() << kNoData << ": meshes/stanford-bunny.obj";
  const Scene bunny = scene_of_mesh(kShared / "meshes/stanford-bunny.obj", access_without_pictures());
  EXPECT_EQ(fault_of(bunny), "");
  EXPECT_EQ(bunny.meshes.at(0).triangles.size(), 69451u);
  EXPECT_TRUE(bunny.meshes[0].normals.empty());
  const Scene spot = scene_of_mesh(kShared / "meshes/spot.obj", access_without_pictures());
  EXPECT_EQ(fault_of(spot), "");
  EXPECT_EQ(spot.meshes.at(0).triangles.size(), 5856u);
  EXPECT_EQ(spot.meshes[0].uvs.size(), spot.meshes[0].positions.size());
}

TEST(SharedData, ProfilesGiveTheLumensThatTheyState) {
  if (!has("ies/Type C - 01.ies")) GTEST_SKIP() << kNoData << ": ies/Type C - 01.ies";
  const auto lumens = [](const char* name) {
    const Profile p = profile_of(likeness::files::read_whole(kShared / "ies" / name, kMostProfileBytes), name);
    return solid_angle(p) * static_cast<double>(peak(p));
  };
  EXPECT_NEAR(lumens("Type C - 01.ies"), 13032, 1);                      // its line _ABSLUMENS
  EXPECT_NEAR(lumens("02a7562c650498ebb301153dbbf59207.ies"), 9600, 1);  // its line LAMP; 90 to 270 degrees
  EXPECT_GT(lumens("Type B - 01.ies"), 1000);
}

TEST(SharedData, BrokenProfilesAreOneLine) {
  if (!has("ies/Invalid Profile - 01.ies")) GTEST_SKIP() << kNoData << ": ies/Invalid Profile - 01.ies";
  const auto said = [](const std::string& name) {
    try {
      scene_with("\"lights\": [{\"type\": \"point\", \"profile\": \"ies/" + name + "\"}]");
    } catch (const likeness::files::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(said("Invalid Profile - 01.ies"), HasSubstr("Invalid Profile - 01.ies:1: has no line TILT="));
  EXPECT_THAT(said("Truncated Profile - 01.IES"), HasSubstr("Truncated Profile - 01.IES:26: the file ends where"));
}

}  // namespace
}  // namespace likeness::scene::test
