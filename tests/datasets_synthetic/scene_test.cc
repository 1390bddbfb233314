#include "datasets_synthetic/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <CLI/CLI.hpp>

#include <glm/geometric.hpp>

#include "datasets_synthetic/command.h"
#include "datasets_synthetic/scene_files.h"
#include "datasets_synthetic/scene_shapes.h"
#include "render/files/files.h"
#include "render/scene/read_scene.h"
#include "tests/render/temporary_folder.h"

namespace likeness::datasets_synthetic {
namespace {

using likeness::test::TemporaryFolder;
using testing::HasSubstr;
using testing::IsEmpty;

const SceneKind& kind(std::string_view name) {
  for (const SceneKind& k : kSceneKinds)
    if (k.name == name) return k;
  throw std::logic_error("no such kind");
}

scene::Scene made(std::string_view name, const TemporaryFolder& folder, SceneOptions options = {}) {
  options.folder = folder / std::string(name);
  return scene::read_scene(write_scene(kind(name), options).at(0));
}

std::set<std::string> repairs_of(const scene::Scene& scene) {
  std::set<std::string> out;
  for (const scene::Repair& r : scene.repairs) out.insert(r.what + " (" + std::to_string(r.count) + ")");
  return out;
}

std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      out[entry.path().lexically_relative(folder).string()] = files::read_whole(entry.path(), 100 << 20);
  return out;
}

TEST(MakeScene, EveryKindIsReadAndOnlyTheTortureNeedsRepairs) {
  const TemporaryFolder folder;
  for (const SceneKind& k : kSceneKinds) {
    const scene::Scene scene = made(k.name, folder);
    EXPECT_EQ(scene.name, k.name);
    EXPECT_FALSE(scene.cameras.empty()) << k.name;
    EXPECT_FALSE(scene.instances.empty()) << k.name;
    EXPECT_TRUE(!scene.lights.empty() || scene.environment) << k.name;
    EXPECT_EQ(scene.cameras[0].width, k.width);
    EXPECT_EQ(scene.cameras[0].height, k.height);
    if (k.name != "torture") {
      EXPECT_THAT(repairs_of(scene), IsEmpty()) << k.name;
    }
  }
}

TEST(MakeScene, TheTortureIsRepairedAsItIsMeantToBe) {
  const TemporaryFolder folder;
  const scene::Scene scene = made("torture", folder);
  EXPECT_THAT(repairs_of(scene),
              testing::UnorderedElementsAre(
                  "normals without a direction made from their triangles (2)", "texels that are no numbers made 0 (37)",
                  "texels without bound made finite (38)",
                  "triangles with a corner that is no number, or beyond 1e9 m, left out (2)",
                  "triangles with a repeated or absent corner left out (1)", "triangles without area left out (1)",
                  "vertices that are no numbers, or beyond 1e9 m, taken out (2)"));
}

TEST(MakeScene, TheSameOptionsGiveTheSameBytes) {
  const TemporaryFolder folder;
  for (const SceneKind& k : kSceneKinds) {
    SceneOptions options;
    options.folder = folder / (std::string(k.name) + "_a");
    write_scene(k, options);
    const auto first = files_in(options.folder);
    options.folder = folder / (std::string(k.name) + "_b");
    write_scene(k, options);
    EXPECT_EQ(first, files_in(options.folder)) << k.name;
  }
}

TEST(MakeScene, TheSeedMovesWhatIsScattered) {
  const TemporaryFolder folder;
  for (const std::string_view name : {"corridor", "teeth", "eye", "distance", "torture"}) {
    SceneOptions options;
    options.folder = folder / (std::string(name) + "_a");
    write_scene(kind(name), options);
    const auto first = files_in(options.folder);
    options.seed = 1;
    options.folder = folder / (std::string(name) + "_b");
    write_scene(kind(name), options);
    EXPECT_NE(first, files_in(options.folder)) << name;
  }
}

TEST(MakeScene, FillsThePicture) {
  const TemporaryFolder folder;
  for (const SceneKind& k : kSceneKinds) {
    const scene::Scene scene = made(k.name, folder);
    const scene::Camera& camera = scene.cameras[0];
    const scene::Bounds box = scene::bounds(scene);
    ASSERT_FALSE(box.is_empty());
    // The middle of what stands there, or (in rooms) the camera itself, is in sight.
    const glm::vec3 at(camera.world_from_camera[3]);
    const bool is_within = at.x > box.low.x && at.x < box.high.x && at.z > box.low.z && at.z < box.high.z;
    const glm::vec3 to = 0.5f * (box.low + box.high) - at;
    EXPECT_TRUE(is_within || glm::dot(to, -glm::vec3(camera.world_from_camera[2])) > 0.9f * glm::length(to)) << k.name;
  }
}

TEST(Cornell, HasTheMeasuredSizesAndFacesInwards) {
  const TemporaryFolder folder;
  const scene::Scene scene = made("cornell", folder);
  const scene::Bounds box = scene::bounds(scene);
  EXPECT_NEAR(box.low.x, 0, 1e-7);
  EXPECT_NEAR(box.high.x, 0.556, 1e-6);   // float
  EXPECT_NEAR(box.high.y, 0.5488, 1e-6);  // float
  EXPECT_NEAR(box.high.z, 0.5592, 1e-6);  // float
  double area = 0;
  std::size_t count = 0;
  for (const scene::Mesh& mesh : scene.meshes) {
    const bool is_block = mesh.name.find("block") != std::string::npos;
    glm::vec3 middle(0);
    for (const glm::vec3& p : mesh.positions) middle += p / static_cast<float>(mesh.positions.size());
    if (!is_block) middle = {0.278f, 0.274f, 0.28f};
    for (const auto& t : mesh.triangles) {
      const glm::vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      const glm::vec3 normal = glm::cross(b - a, c - a);
      const float outward = glm::dot(normal, (a + b + c) / 3.0f - middle);
      EXPECT_TRUE(is_block ? outward > 0 : outward < 0) << mesh.name;
      area += 0.5 * static_cast<double>(glm::length(normal));
      ++count;
    }
  }
  EXPECT_EQ(count, 30u);
  // Room: floor and ceiling, three walls; blocks: their tops and sides, from the published corners.
  EXPECT_NEAR(area, 1.5363 + 0.3844, 5e-4);  // the left wall is not quite flat
  const auto& lamp = std::get<scene::RectangleLight>(scene.lights.at(0).shape);
  EXPECT_LT(glm::cross(lamp.half_u, lamp.half_v).y, 0) << "it shines down";
  EXPECT_FLOAT_EQ(lamp.radiance.x, 17);
  EXPECT_NEAR(scene.cameras[0].focal_y, 512 * 35.0 / 25, 1e-6);  // rounding
}

TEST(Corridor, HasAsManyLightsAsAskedAllInside) {
  const TemporaryFolder folder;
  for (const int lights : {1, 64, 500}) {
    SceneOptions options;
    options.lights = lights;
    const scene::Scene scene = made("corridor", folder, options);
    ASSERT_EQ(scene.lights.size(), static_cast<std::size_t>(lights));
    const scene::Bounds box = scene::bounds(scene);
    std::set<std::size_t> kinds;
    for (const scene::Light& light : scene.lights) {
      kinds.insert(light.shape.index());
      EXPECT_EQ(light.range, 5);
      std::visit(
          [&](const auto& shape) {
            glm::vec3 at(0);
            if constexpr (requires { shape.position; }) at = shape.position;
            else if constexpr (requires { shape.center; }) at = shape.center;
            for (int k = 0; k < 3; ++k) EXPECT_TRUE(at[k] > box.low[k] && at[k] < box.high[k]);
          },
          light.shape);
    }
    EXPECT_EQ(kinds.size(), lights == 1 ? 1u : 5u);
  }
}

TEST(Spheres, TurnTheLightOverTheFrames) {
  const TemporaryFolder folder;
  SceneOptions options;
  options.frames = 4;
  options.light_deg = 0;
  options.folder = folder / "turn";
  const auto scenes = write_scene(kind("spheres"), options);
  ASSERT_EQ(scenes.size(), 4u);
  const std::array<glm::vec2, 4> expected{glm::vec2{0, -1}, {-1, 0}, {0, 1}, {1, 0}};  // x, z of its way
  for (std::size_t i = 0; i < 4; ++i) {
    const scene::Scene scene = scene::read_scene(scenes[i]);
    const auto& light = std::get<scene::DirectionalLight>(scene.lights.at(0).shape);
    const glm::vec2 way = glm::normalize(glm::vec2(light.direction.x, light.direction.z));
    EXPECT_NEAR(glm::dot(way, expected[i]), 1, 1e-5) << i;  // digits of the file
    EXPECT_TRUE(scene.lights[0].is_movable);
    EXPECT_EQ(scene.instances.size(), 28u);
  }
}

TEST(SceneShapes, AreClosedAndTheirNormalsPointOutwards) {
  const TemporaryFolder folder;
  for (const std::string_view name : {"teeth", "eye"})
    for (const scene::Mesh& mesh : made(name, folder).meshes) {
      if (mesh.is_sphere) continue;
      double volume = 0;
      std::size_t against = 0;
      for (const auto& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
        volume += glm::dot(a, glm::cross(b, c)) / 6;
        const glm::dvec3 flat = glm::cross(b - a, c - a);
        for (const scene::Index corner : t) against += glm::dot(flat, glm::dvec3(mesh.normals[corner])) <= 0;
      }
      EXPECT_GT(volume, 0) << mesh.name;
      EXPECT_EQ(against, 0u) << mesh.name << " of " << 3 * mesh.triangles.size();
    }
}

TEST(SceneShapes, TheEyeHasTheVolumeOfItsSpheres) {
  const TemporaryFolder folder;
  double volume = 0;
  const scene::Scene scene = made("eye", folder);
  for (const auto& t : scene.meshes.at(0).triangles) {
    const auto& p = scene.meshes[0].positions;
    volume += glm::dot(glm::dvec3(p[t[0]]), glm::cross(glm::dvec3(p[t[1]]), glm::dvec3(p[t[2]]))) / 6;
  }
  // The sclera's ball, and the cornea's cap less the sclera's: h = R - sqrt(R^2 - a^2), V = pi h (3 a^2 + h^2) / 6.
  const auto cap = [](double radius) {
    const double a = 5.8, h = radius - std::sqrt(radius * radius - a * a);
    return 3.14159265 * h * (3 * a * a + h * h) / 6;
  };
  const double expected = 4.0 / 3 * 3.14159265 * 12 * 12 * 12 + cap(7.8) - cap(12);
  EXPECT_NEAR(volume * 1e9 / expected, 1, 0.003);  // facets, and the rounded limbus: 0.0012 measured
}

TEST(SceneFiles, KeepTextureCoordinatesAndLeaveOutIdleVertices) {
  const TemporaryFolder folder;
  scene::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {0, 1, 0}};
  mesh.uvs = {{0.1f, 0.9f}, {0.5f, 0.5f}, {1, 0.75f}, {0, 0.25f}};
  mesh.triangles = {{0, 2, 3}};
  SceneFiles files(folder.path(), "test");
  files.add_mesh("one", mesh);
  files.add_material("plain", SceneJson::object());
  files.add_instance("one", "plain");
  files.write();
  const scene::Scene back = scene::read_scene(folder / "scene.json");
  ASSERT_EQ(back.meshes.at(0).uvs.size(), 3u);
  EXPECT_NEAR(back.meshes[0].uvs[0].y, 0.9, 1e-6);  // 1 - v, twice, in float
  EXPECT_NEAR(back.meshes[0].uvs[1].y, 0.75, 1e-6);
  EXPECT_EQ(back.meshes[0].positions[1].x, 1);
}

TEST(SceneNoise, IsSmoothRepeatsAndHasNoMean) {
  double sum = 0;
  for (int i = 0; i < 10'000; ++i) {
    const double x = 0.037 * i, y = 0.011 * i;
    const double n = noise(x, y, 3);
    ASSERT_LE(std::abs(n), 1);
    EXPECT_NEAR(noise(x + 1e-6, y, 3), n, 1e-5);  // slope below 4
    EXPECT_NEAR(noise(x, y, 5, 7), noise(x + 14, y, 5, 7), 1e-9);
    sum += n;
  }
  EXPECT_NEAR(sum / 10'000, 0, 0.1);  // 1500 cells of deviation 0.4: 0.01
  EXPECT_NE(noise(0.5, 0.5, 1), noise(0.5, 0.5, 2));
}

// What the command says.
class MakeSceneCommand : public testing::Test {
 protected:
  std::string run(std::string arguments) {
    for (std::size_t at; (at = arguments.find("FOLDER")) != std::string::npos;)
      arguments.replace(at, 6, folder_.path().string());
    CLI::App program{"", "likeness"};
    int exit_code = -1;
    add_make(program, exit_code);
    std::ostringstream out;
    std::streambuf* const terminal = std::cout.rdbuf(out.rdbuf());
    try {
      program.parse("make scene " + arguments);
    } catch (...) {
      std::cout.rdbuf(terminal);
      throw;
    }
    std::cout.rdbuf(terminal);
    EXPECT_EQ(exit_code, 0);
    return out.str();
  }
  std::string refusal(const std::string& arguments) {
    try {
      run(arguments);
    } catch (const files::UsageError& error) {
      return error.what();
    }
    return "not refused";
  }
  TemporaryFolder folder_;
};

TEST_F(MakeSceneCommand, PrintsTheSceneFileThatItWrote) {
  EXPECT_EQ(run("ggx_sphere --out FOLDER/a --width 32 --height 16"), (folder_ / "a/scene.json").string() + "\n");
  const scene::Scene scene = scene::read_scene(folder_ / "a/scene.json");
  EXPECT_EQ(scene.cameras[0].width, 32);
  EXPECT_EQ(scene.cameras[0].height, 16);
  EXPECT_NO_THROW(run("cornell --out FOLDER/a")) << "it replaces its own";
  EXPECT_NO_THROW(run("cornell --width 1 --height 16384 --out FOLDER/a")) << "the ends of the range";
}

TEST_F(MakeSceneCommand, ListsAndExplainsEveryKind) {
  const std::string list = run("--list");
  for (const SceneKind& k : kSceneKinds) {
    EXPECT_THAT(list, HasSubstr(std::string(k.name)));
    EXPECT_THAT(list, HasSubstr(std::string(k.text)));
  }
  CLI::App program{"", "likeness"};
  int exit_code = -1;
  add_make(program, exit_code);
  const std::string help = program.get_subcommand("make")->get_subcommand("scene")->help();
  for (const SceneKind& k : kSceneKinds) EXPECT_THAT(help, HasSubstr(std::string(k.name)));
  EXPECT_THAT(help, HasSubstr("Examples"));
}

TEST_F(MakeSceneCommand, RefusesInWords) {
  EXPECT_THAT(refusal("cornel --out FOLDER/a"), HasSubstr("there is no scene \"cornel\"; did you mean cornell?"));
  EXPECT_THAT(refusal("--out FOLDER/a"), HasSubstr("no kind of scene is named; there are spheres, cornell"));
  EXPECT_THAT(refusal("cornell"), HasSubstr("--out is missing"));
  EXPECT_THAT(refusal("cornell --lights 5 --out FOLDER/a"),
              HasSubstr("--lights is for the scene corridor, not for cornell"));
  EXPECT_THAT(refusal("corridor --lights 0 --out FOLDER/a"), HasSubstr("--lights = 0 is outside [1, 10000]"));
  EXPECT_THAT(refusal("corridor --lights 10001 --out FOLDER/a"), HasSubstr("is outside"));
  EXPECT_THAT(refusal("eye --frames 3 --out FOLDER/a"), HasSubstr("--frames is for the scene spheres"));
  EXPECT_THAT(refusal("spheres --frames 361 --out FOLDER/a"), HasSubstr("--frames = 361 is outside [1, 360]"));
  EXPECT_THAT(refusal("spheres --light-deg nan --out FOLDER/a"), HasSubstr("--light-deg = nan"));
  EXPECT_THAT(refusal("eye --width 0 --out FOLDER/a"), HasSubstr("--width = 0 is outside [1, 16384]"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a"));
  files::write_whole(folder_ / "theirs/scene.json", "{}");
  EXPECT_THAT(refusal("eye --out FOLDER/theirs"), HasSubstr("was not made by this command and is not overwritten"));
  files::write_whole(folder_ / "file", "");
  EXPECT_THAT(refusal("eye --out FOLDER/file"), HasSubstr("is a file; a scene is a folder"));
}

TEST(PrettyJson, KeepsShortThingsOnALine) {
  EXPECT_EQ(pretty({{"a", {1, 2.5}}, {"b", SceneJson::object()}}), "{\n  \"a\": [1, 2.5],\n  \"b\": {}\n}\n");
  const std::string text =
      pretty({{"a", std::string(120, 'x')}, {"b", {{"c", std::string(90, 'y')}, {"d", 12345678}}}});
  EXPECT_EQ(SceneJson::parse(text)["b"]["d"], 12345678);
  EXPECT_THAT(text, HasSubstr("\n    \"d\": 12345678\n"));
}

}  // namespace
}  // namespace likeness::datasets_synthetic
