#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/files/files.h"
#include "render/image/layers.h"
#include "render/image/read.h"
#include "render/view/view.h"
#include "tests/render/command/process.h"

// `likeness render`: what each option does.
namespace likeness::render_command {
namespace {

using test::Ran;
using test::Workshop;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

class RenderCommand : public testing::Test {
 protected:
  void SetUp() override { shop.write_ball(); }

  // Renders the ball, at 4 samples a pixel if `words` do not say how many.
  Ran render(const Words& words = {}) const {
    Words all{"render", "ball.json"};
    if (std::find(words.begin(), words.end(), "--spp") == words.end()) all.insert(all.end(), {"--spp", "4"});
    all.insert(all.end(), words.begin(), words.end());
    Ran ran = shop.run(all);
    EXPECT_EQ(ran.exit_code, 0) << ran.error;
    return ran;
  }
  Json json(Words words = {}) const {
    words.push_back("--json");
    return Json::parse(render(words).out);
  }
  image::Layers layers(const std::string& name = "ball.exr") const { return image::read_layers(shop / name); }
  std::vector<float> light(const std::string& name = "ball.exr") const { return layers(name).find("")->data; }
  static double mean(const std::vector<float>& values) {
    double sum = 0;
    for (const float v : values) sum += static_cast<double>(v);
    return sum / static_cast<double>(values.size());
  }

  Workshop shop;
};

TEST_F(RenderCommand, WritesLightAndItsViewBesideEachOther) {
  const Ran ran = render();
  EXPECT_EQ(shop.files(), (Words{"ball.exr", "ball.json", "ball.png"}));
  EXPECT_EQ(ran.error, "");
  const image::Layers exr = layers();
  EXPECT_EQ(exr.width, 32);
  EXPECT_EQ(exr.height, 24);
  ASSERT_NE(exr.find(""), nullptr);
  ASSERT_NE(exr.find("variance"), nullptr);
  EXPECT_EQ(exr.layers.size(), 2u);
  for (const float v : exr.find("")->data) EXPECT_TRUE(std::isfinite(v) && v >= 0);
  EXPECT_NEAR(exr.find("")->data[0], 0.1, 1e-6) << "the corner sees the environment";

  image::Picture light(32, 24);
  light.rgb = exr.find("")->data;
  EXPECT_EQ(image::read_texels(shop / "ball.png").bytes, view::show(light, {}).rgb);
}

TEST_F(RenderCommand, SaysWhatItWrote) {
  const std::string out = render().out;
  for (const char* word : {"ball.exr", "32 x 24", "4 samples a pixel", "relative error", "ball.png", "srgb"})
    EXPECT_NE(out.find(word), std::string::npos) << out;
}

TEST_F(RenderCommand, PutsFilesWhereItIsTold) {
  render({"--out", "deep/er/a.exr", "--png", "b.png"});
  EXPECT_EQ(shop.files(), (Words{"b.png", "ball.json", "deep", "deep/er", "deep/er/a.exr"}));
  render({"--out", "c.exr", "--no-png"});
  EXPECT_TRUE(std::filesystem::exists(shop / "c.exr"));
  EXPECT_FALSE(std::filesystem::exists(shop / "c.png"));
}

TEST_F(RenderCommand, SumsUpAsJson) {
  const Json all = json();
  EXPECT_EQ(all.at("scene"), "ball.json");
  EXPECT_EQ(all.at("samples"), 4);
  EXPECT_EQ(all.at("samples_before"), 0);
  EXPECT_EQ(all.at("size"), (std::vector<int>{32, 24}));
  EXPECT_EQ(all.at("camera").at("name"), "front");
  EXPECT_EQ(all.at("integrator"), "reference");
  EXPECT_EQ(all.at("finished"), true);
  EXPECT_EQ(all.at("rejected_samples"), 0);
  EXPECT_GT(all.at("relative_error").get<double>(), 0);
  EXPECT_GT(all.at("seconds").get<double>(), 0);
  EXPECT_GT(all.at("cpu_seconds").get<double>(), 0);
  EXPECT_GE(all.at("seconds_all"), all.at("seconds"));
  EXPECT_GT(all.at("peak_memory_bytes").get<double>(), 1e6);
  EXPECT_EQ(all.at("repairs").size(), 0u);
  EXPECT_EQ(all.at("plan").at("digest").get<std::string>().size(), 64u);
  EXPECT_EQ(all.at("plan").at("on"), (Words{"diffuse", "area_lights", "environment"}));
  EXPECT_EQ(all.at("files").at("png"), "ball.png");
}

TEST_F(RenderCommand, WritesIntoTheExrWhatDoesNotChangeFromRunToRun) {
  const Json all = json();
  const Json inside = Json::parse(layers().metadata);
  for (const auto& [key, value] : inside.items()) EXPECT_EQ(value, all.at(key)) << key;
  EXPECT_FALSE(inside.contains("seconds"));
  const std::string first = shop.content("ball.exr");
  render();
  EXPECT_TRUE(shop.content("ball.exr") == first) << "the same command makes the same bytes";
}

TEST_F(RenderCommand, StatesTheLevelOfEverySettingOfAFrame) {
  const Json plain = Json::parse(shop.run({"render", "ball.json", "--integrator", "runtime", "--json"}).out);
  const Json settings = plain.at("settings");
  for (const char* name : {"pixel_samples", "light_samples", "environment"})
    EXPECT_TRUE(settings.contains(name)) << name;
  EXPECT_EQ(Json::parse(layers().metadata).at("settings"), settings);
  EXPECT_EQ(settings.at("pixel_samples"), "1");
  files::write_whole(shop / "better.json",
                     R"({"format": "likeness quality", "version": 1, "settings": {"pixel_samples": 4}})");
  const Ran better = shop.run({"render", "ball.json", "--integrator", "runtime", "--quality", "better.json", "--json"});
  ASSERT_EQ(better.exit_code, 0) << better.error;
  EXPECT_EQ(Json::parse(better.out).at("settings").at("pixel_samples"), "4");
  EXPECT_FALSE(json().contains("settings")) << "the path tracer has none";
}

TEST_F(RenderCommand, DoesNotDependOnThreads) {
  render({"--threads", "1"});
  const std::string one = shop.content("ball.exr");
  render({"--threads", "5"});
  EXPECT_TRUE(shop.content("ball.exr") == one);
}

TEST_F(RenderCommand, LooksThroughTheCameraThatIsNamed) {
  EXPECT_EQ(json({"--camera", "side"}).at("size"), (std::vector<int>{24, 32}));
  const std::string by_name = shop.content("ball.exr");
  EXPECT_EQ(json({"--camera", "1"}).at("camera").at("index"), 1);
  EXPECT_TRUE(shop.content("ball.exr") == by_name);
}

TEST_F(RenderCommand, MakesThePictureOfAnotherSize) {
  render();
  const double before = mean(light());
  EXPECT_EQ(json({"--size", "64x48", "--spp", "16"}).at("size"), (std::vector<int>{64, 48}));
  EXPECT_NEAR(mean(light()) / before, 1, 0.05) << "the same is seen";  // 768 pixels' noise and edges
}

TEST_F(RenderCommand, TakesAsManySamplesAsItIsTold) {
  EXPECT_EQ(json({"--spp", "7"}).at("samples"), 7);
  EXPECT_EQ(json({"--spp", "1"}).at("relative_error"), nullptr) << "not known of one sample";
}

TEST_F(RenderCommand, EndsAtATime) {
  const Json all = Json::parse(shop.run({"render", "ball.json", "--time", "0.3", "--json"}).out);
  EXPECT_GT(all.at("seconds").get<double>(), 0.29);
  EXPECT_LT(all.at("seconds").get<double>(), 5) << "on a busy machine";
  EXPECT_GT(all.at("samples").get<int>(), 1);
}

TEST_F(RenderCommand, EndsAtAnError) {
  const Json all = Json::parse(shop.run({"render", "ball.json", "--error", "1e-4", "--json"}).out);
  EXPECT_LE(all.at("relative_error").get<double>(), 1e-4);
  EXPECT_GT(all.at("relative_error").get<double>(), 5e-5) << "and not long after it";
  EXPECT_GT(all.at("samples").get<int>(), 64) << "which is not where it ends without an error";
}

TEST_F(RenderCommand, HasOtherNoiseForAnotherSeed) {
  render({"--seed", "1"});
  const auto one = light();
  render({"--seed", "2"});
  EXPECT_NE(light(), one);
  EXPECT_NEAR(mean(light()) / mean(one), 1, 0.05);
}

TEST_F(RenderCommand, FollowsLightAsFarAsItIsTold) {
  shop.write_ball("ball.json", "\"environment\": {\"radiance\": [0.1, 0.12, 0.15]}",
                  "\"environment\": {\"radiance\": 0}");
  render({"--bounces", "0"});
  EXPECT_EQ(mean(light()), 0) << "the lamp is not in view, and nothing is lit";
  render({"--bounces", "1"});
  EXPECT_GT(mean(light()), 0.001);
}

TEST_F(RenderCommand, KeepsLayersOfTheFirstSurface) {
  render({"--layers"});
  const image::Layers exr = layers();
  std::set<std::string> names;
  for (const image::Layer& layer : exr.layers) names.insert(layer.name);
  EXPECT_EQ(names, (std::set<std::string>{"", "variance", "depth", "position", "normal", "shading_normal", "uv",
                                          "base_color", "emitted", "direct", "indirect", "diffuse", "specular"}));
  const std::size_t middle = 12 * 32 + 16;
  EXPECT_NEAR(exr.find("depth")->data[middle], 3, 0.05) << "the camera is 4 m from the center of a ball of 1 m";
  EXPECT_NEAR(exr.find("base_color")->data[3 * middle], 0.6, 1e-3);
  for (std::size_t i = 0; i < exr.find("")->data.size(); ++i)
    EXPECT_NEAR(exr.find("")->data[i],
                exr.find("emitted")->data[i] + exr.find("direct")->data[i] + exr.find("indirect")->data[i], 1e-5);
}

TEST_F(RenderCommand, KeepsALayerOfEachLightThoughTwoHaveOneName) {
  const std::string lamp =
      R"({"type": "sphere", "name": "lamp", "position": [2, 3, 2], "radius": 0.3, "strength": 20})";
  const std::string other = R"({"type": "point", "name": "lamp", "position": [-3, 0, 2], "strength": 5})";
  shop.write_ball("ball.json", lamp, lamp + ", " + other);
  render({"--light-layers"});
  const image::Layers exr = layers();
  std::vector<std::string> names;
  float most = 0;
  for (const image::Layer& layer : exr.layers)
    if (layer.name.starts_with("visibility.lamp")) {
      names.push_back(layer.name);
      EXPECT_NE(exr.find("light." + layer.name.substr(11)), nullptr) << layer.name;
      for (const float v : layer.data) most = std::max(most, v);
    }
  EXPECT_EQ(names.size(), 2u);
  EXPECT_EQ(most, 1);
}

TEST_F(RenderCommand, ShowsItAsTheCommandLineSaysInsteadOfTheScene) {
  render();
  const auto plain = image::read_texels(shop / "ball.png").bytes;
  const std::string exr = shop.content("ball.exr");
  const auto shown = [&](const Words& words) {
    render(words);
    EXPECT_TRUE(shop.content("ball.exr") == exr) << "the light is the same";
    return image::read_texels(shop / "ball.png").bytes;
  };
  const auto sum = [](const std::vector<std::uint8_t>& v) {
    double out = 0;
    for (const auto b : v) out += b;
    return out;
  };
  EXPECT_GT(sum(shown({"--ev", "1"})), 1.2 * sum(plain));
  EXPECT_LT(sum(shown({"--ev=-1"})), 0.9 * sum(plain));
  EXPECT_NE(shown({"--view", "gt"}), plain);
  EXPECT_NE(shown({"--view", "aces"}), plain);
  shop.write_ball("ball.json", "\"version\": 1,", R"("version": 1, "view": {"ev": 1, "name": "gt"},)");
  EXPECT_EQ(shown({"--ev", "0", "--view", "srgb"}), plain);
}

TEST_F(RenderCommand, MakesTheSamePictureWithEveryEffectForced) {
  render();
  const auto plain = light();
  EXPECT_EQ(json({"--force", "all"}).at("plan").at("forced"), true);
  const auto forced = light();
  ASSERT_EQ(forced.size(), plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i)
    EXPECT_NEAR(forced[i], plain[i], 1e-6 * std::max(1.0f, plain[i])) << i;  // the issue's number
}

TEST_F(RenderCommand, SaysWhatWasPutRight) {
  files::write_whole(shop / "bent.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\n");
  const Ran ran = shop.run({"render", "bent.obj", "--spp", "1", "--size", "8x8", "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.error;
  EXPECT_TRUE(ran.error.starts_with("put right: ")) << ran.error;
  EXPECT_NE(ran.error.find("bent.obj: triangles without area left out (1)\n"), std::string::npos) << ran.error;
  const Json all = Json::parse(ran.out);
  ASSERT_GE(all.at("repairs").size(), 1u);
  EXPECT_EQ(std::count(ran.error.begin(), ran.error.end(), '\n'), static_cast<long>(all.at("repairs").size()));
  EXPECT_EQ(all.at("repairs")[0].at("count"), 1);
}

// The loader of the program tells of every library that it opens.
TEST_F(RenderCommand, LoadsNoOpenImageIoForASceneWithoutTextures) {
  const Ran ran = shop.run({"render", "ball.json", "--spp", "1"}, {"LD_DEBUG=files"});
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_NE(ran.error.find("libembree3"), std::string::npos) << "the loader says what it loads";
  EXPECT_EQ(ran.error.find("libOpenImageIO"), std::string::npos);
}

TEST_F(RenderCommand, ShowsAPreviewWhileItRuns) {
  const Ran ran = shop.run({"render", "ball.json", "--time", "4", "--preview", "now.png", "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.error;
  const image::Texels now = image::read_texels(shop / "now.png");
  EXPECT_EQ(now.width, 32);
  EXPECT_NE(shop.content("now.png"), shop.content("ball.png")) << "it is older than the finished one";
}

TEST_F(RenderCommand, IsAskedForHelpAndTeaches) {
  const std::string help = shop.run({"render", "--help"}).out;
  for (const char* word : {"--out",          "--png",        "--no-png",  "--camera",  "--size",    "--spp",
                           "--time",         "--error",      "--seed",    "--bounces", "--threads", "--layers",
                           "--light-layers", "--integrator", "--ev",      "--view",    "--display", "--ocio",
                           "--force",        "--resume",     "--preview", "--json",    "Examples",  "docs/render.md"})
    EXPECT_NE(help.find(word), std::string::npos) << word;
}

}  // namespace
}  // namespace likeness::render_command
