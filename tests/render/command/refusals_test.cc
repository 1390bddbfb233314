#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "render/files/files.h"
#include "tests/render/command/process.h"

// What `likeness render` and `likeness plan` say no to: one line, an exit code, and no file.
namespace likeness::render_command {
namespace {

using test::Ran;
using test::Workshop;
using Words = std::vector<std::string>;

struct Refusal {
  Words words;
  int exit_code;
  Words says;
};

void expect_refused(const Workshop& shop, const Refusal& r) {
  const auto before = shop.files();
  const Ran ran = shop.run(r.words);
  std::string line;
  for (const std::string& word : r.words) line += word + " ";
  EXPECT_EQ(ran.exit_code, r.exit_code) << line << "\n" << ran.error;
  EXPECT_EQ(ran.out, "") << line;
  EXPECT_EQ(std::count(ran.error.begin(), ran.error.end(), '\n'), 1) << line << "\n" << ran.error;
  for (const std::string& word : r.says)
    EXPECT_NE(ran.error.find(word), std::string::npos) << line << "\nsaid: " << ran.error << "not: " << word;
  EXPECT_EQ(shop.files(), before) << line << "left something behind";
}

TEST(RenderRefuses, WhatIsNoOptionOrNoValueOfIt) {
  const Workshop shop;
  shop.write_ball();
  const std::vector<Refusal> refusals{
      {{"render"}, 2, {"likeness render", "SCENE", "--help"}},
      {{"render", "ball.json", "--smaples", "3"}, 2, {"unknown option --smaples", "--help"}},
      {{"render", "ball.json", "--threds", "3"}, 2, {"did you mean --threads?"}},
      {{"render", "ball.json", "--spp", "0"}, 2, {"likeness render: --spp 0 is outside [1, 16777216]"}},
      {{"render", "ball.json", "--spp", "1.5"}, 2, {"--spp 1.5 is no whole number"}},
      {{"render", "ball.json", "--spp", "nan"}, 2, {"--spp nan is outside"}},
      {{"render", "ball.json", "--spp", "many"}, 2, {"--spp", "many"}},
      {{"render", "ball.json", "--time=-1"}, 2, {"--time -1 is outside [0, "}},
      {{"render", "ball.json", "--error=-1"}, 2, {"--error -1 is outside [0, "}},
      {{"render", "ball.json", "--seed=-1"}, 2, {"--seed -1 is outside [0, "}},
      {{"render", "ball.json", "--bounces=-1"}, 2, {"--bounces -1 is outside [0, "}},
      {{"render", "ball.json", "--threads", "5000"}, 2, {"--threads 5000 is outside [0, 1024]"}},
      {{"render", "ball.json", "--size", "12"}, 2, {"--size \"12\"", "640x360"}},
      {{"render", "ball.json", "--size", "70000x70000"}, 2, {"--size \"70000x70000\" is too large", "16384x16384"}},
      {{"render", "ball.json", "--camera", "frnt"},
       2,
       {"--camera \"frnt\"", "\"front\", \"side\"", "did you mean front?"}},
      {{"render", "ball.json", "--camera", "2"}, 2, {"--camera \"2\"", "0 to 1"}},
      {{"render", "ball.json", "--integrator", "refrence"},
       2,
       {"--integrator \"refrence\"", "did you mean reference?"}},
      {{"render", "ball.json", "--integrator", "runtime", "--spp", "4"},
       2,
       {"--spp is of the path tracer", "--quality"}},
      {{"render", "ball.json", "--layers", "--integrator", "runtime"}, 2, {"--layers is of the path tracer"}},
      {{"render", "ball.json", "--force", "diffuse"}, 2, {"--force \"diffuse\"", "only all"}},
      {{"render", "ball.json", "--out", "a.png"}, 2, {"--out \"a.png\"", ".exr"}},
      {{"render", "ball.json", "--png", "a.exr"}, 2, {"--png \"a.exr\"", ".png"}},
      {{"render", "ball.json", "--preview", "a.jpg"}, 2, {"--preview \"a.jpg\"", ".png"}},
      {{"render", "ball.json", "--preview", "ball.png"}, 2, {"--preview", "another name"}},
      {{"render", "ball.json", "--png", "a.png", "--no-png"}, 2, {"--png and --no-png"}},
      {{"render", "ball.json", "--ev", "1e9"}, 3, {"ev = 1e+09", "[-100, 100]"}},
      {{"render", "ball.json", "--view", "srbg"}, 3, {"srbg"}},
      {{"render", "ball.json", "--ocio", "none.ocio"}, 3, {"none.ocio"}},
      {{"render", "ball.json", "--display", "cinema"}, 3, {"no OpenColorIO config"}},
      {{"plan", "ball.json", "--out", "plan.pdf"}, 2, {"--out \"plan.pdf\"", ".html or .svg"}},
      {{"plan", "ball.json", "--force", "some"}, 2, {"--force \"some\""}},
      {{"plan", "ball.json", "--camera", "back"}, 2, {"--camera \"back\""}},
      {{"plan", "ball.json", "--time", "--repeats", "1"}, 2, {"--repeats 1 is outside [3, 1000]"}},
      {{"plan", "ball.json", "--time", "--force", "all"}, 2, {"--time", "--force"}},
  };
  for (const Refusal& r : refusals) expect_refused(shop, r);
}

TEST(RenderRefuses, ABrokenScene) {
  const Workshop shop;
  shop.write_ball("key.json", "\"fov_deg\"", "\"fov\"");
  shop.write_ball("value.json", "\"radius\": 0.3", "\"radius\": -0.3");
  shop.write_ball("mesh.json", "{\"shape\": \"sphere\"}", "{\"file\": \"none.ply\"}");
  files::write_whole(shop / "poem.json", "Tyger Tyger, burning bright,\n");
  files::write_whole(shop / "empty.json", "");
  files::write_whole(shop / "poem.glb", "In the forests of the night;\n");
  for (const char* command : {"render", "plan"}) {
    expect_refused(shop, {{command, "key.json"}, 3, {"key.json:5: /cameras/0", "fov"}});
    expect_refused(shop, {{command, "value.json"}, 3, {"value.json:", "/lights/0/radius"}});
    expect_refused(shop, {{command, "mesh.json"}, 3, {"none.ply"}});
    expect_refused(shop, {{command, "poem.json"}, 3, {"poem.json:1"}});
    expect_refused(shop, {{command, "empty.json"}, 3, {"empty.json"}});
    expect_refused(shop, {{command, "poem.glb"}, 3, {"poem.glb"}});
    expect_refused(shop, {{command, "none.json"}, 3, {"none.json"}});
    expect_refused(shop, {{command, "."}, 3, {"."}});
  }
}

TEST(RenderRefuses, AFolderThatIsNoneBeforeItRenders) {
  const Workshop shop;
  shop.write_ball();
  files::write_whole(shop / "file", "");
  for (const char* option : {"--out", "--png", "--preview"})
    expect_refused(shop, {{"render", "ball.json", option, option == std::string("--out") ? "file/a.exr" : "file/a.png",
                           "--spp", "1000000"},
                          4,
                          {"file/a.", "cannot be written"}});
  expect_refused(shop, {{"plan", "ball.json", "--out", "file/plan.html"}, 4, {"file/plan.html", "cannot be written"}});
}

TEST(RenderRefuses, AFullDiskInOneLine) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Workshop shop;
  shop.write_ball();
  for (const std::string name : {"full.exr", "full.png", "full.html"})
    std::filesystem::create_symlink("/dev/full", shop / name);
  expect_refused(shop,
                 {{"render", "ball.json", "--spp", "1", "--no-png", "--out", "full.exr"}, 4, {"full.exr", "No space"}});
  expect_refused(shop, {{"plan", "ball.json", "--out", "full.html"}, 4, {"full.html", "No space"}});
  const Ran ran = shop.run({"render", "ball.json", "--spp", "1", "--png", "full.png"});
  EXPECT_EQ(ran.exit_code, 4);
  EXPECT_NE(ran.error.find("full.png"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(shop / "ball.exr")) << "the light is kept though its view is not";
}

}  // namespace
}  // namespace likeness::render_command
