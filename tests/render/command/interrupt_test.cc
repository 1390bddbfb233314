#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/files/files.h"
#include "render/image/layers.h"
#include "render/image/read.h"
#include "tests/render/command/process.h"

// Ctrl-C at a real process, and what it left taken up again.
namespace likeness::render_command {
namespace {

using test::Ran;
using test::Workshop;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

constexpr const char* kForever = "16000000";  // samples: hours

class RenderInterrupted : public testing::Test {
 protected:
  void SetUp() override { shop.write_ball(); }

  // Renders until it has used 0.3 s of CPU, which is some passes, and interrupts it.
  Ran interrupt(Words more = {}, int signal = SIGINT) const {
    Words words{"render", "ball.json", "--spp", kForever};
    words.insert(words.end(), more.begin(), more.end());
    const pid_t child = shop.start(words);
    const double enough = test::cpu_seconds_of(child) + 0.3;
    for (int i = 0; i < 3000 && test::cpu_seconds_of(child) < enough; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ::kill(child, signal);
    return shop.wait_for(child);
  }
  Ran resume(int samples, Words more = {}) const {
    Words words{"render", "ball.json", "--resume", "--spp", std::to_string(samples)};
    words.insert(words.end(), more.begin(), more.end());
    return shop.run(words);
  }
  int samples_in(const std::string& name) const {
    return Json::parse(image::read_layers(shop / name).metadata).at("samples");
  }
  // Equal in every bit, but for the metadata.
  void expect_same_light(const std::string& a, const std::string& b) const {
    const image::Layers one = image::read_layers(shop / a), two = image::read_layers(shop / b);
    ASSERT_EQ(one.layers.size(), two.layers.size());
    for (std::size_t i = 0; i < one.layers.size(); ++i) {
      EXPECT_EQ(one.layers[i].name, two.layers[i].name);
      EXPECT_EQ(one.layers[i].data, two.layers[i].data) << one.layers[i].name;
    }
  }

  Workshop shop;
};

TEST_F(RenderInterrupted, LeavesAValidPictureAndItsState) {
  const Ran ran = interrupt({"--json"});
  EXPECT_EQ(ran.exit_code, 130) << ran.error;
  EXPECT_EQ(shop.files(), (Words{"ball.exr", "ball.json", "ball.png", "ball.state.exr"}));
  for (const char* word : {"interrupted", "ball.state.exr", "--resume"})
    EXPECT_NE(ran.error.find(word), std::string::npos) << ran.error;
  const Json all = Json::parse(ran.out);
  EXPECT_EQ(all.at("finished"), false);
  EXPECT_GT(all.at("samples").get<int>(), 0);
  EXPECT_EQ(all.at("files").at("state"), "ball.state.exr");
  const image::Layers exr = image::read_layers(shop / "ball.exr");
  for (std::size_t i = 0; i < exr.find("")->data.size(); ++i) {
    const float v = exr.find("")->data[i];
    EXPECT_TRUE(std::isfinite(v) && v >= 0) << v << " at " << i;
  }
  EXPECT_EQ(image::read_texels(shop / "ball.png").width, 32);
}

TEST_F(RenderInterrupted, GoesOnToTheSameBits) {
  for (const Words& options : {Words{}, Words{"--layers", "--camera", "side", "--seed", "7"}}) {
    ASSERT_EQ(interrupt(options).exit_code, 130);
    const int samples = samples_in("ball.exr") + 40;
    const Ran ran = resume(samples, options);
    ASSERT_EQ(ran.exit_code, 0) << ran.error;
    EXPECT_FALSE(std::filesystem::exists(shop / "ball.state.exr")) << "it is of no more use";
    Words straight{"render", "ball.json", "--out", "straight.exr", "--spp", std::to_string(samples)};
    straight.insert(straight.end(), options.begin(), options.end());
    ASSERT_EQ(shop.run(straight).exit_code, 0);
    expect_same_light("ball.exr", "straight.exr");
  }
}

TEST_F(RenderInterrupted, CanBeInterruptedAgainByASignalOfAnotherKindAndWithOtherThreads) {
  ASSERT_EQ(interrupt({"--threads", "1"}).exit_code, 130);
  const int first = samples_in("ball.exr");
  ASSERT_EQ(interrupt({"--resume", "--threads", "2"}, SIGTERM).exit_code, 130);
  const int second = samples_in("ball.exr");
  EXPECT_GT(second, first);
  // A pass has at most 16 samples: pixels that it had reached when it was interrupted have so many more than the rest.
  const int samples = second + 16;
  const Ran ran = resume(samples, {"--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.error;
  EXPECT_EQ(Json::parse(ran.out).at("samples_before"), second);
  ASSERT_EQ(shop.run({"render", "ball.json", "--out", "straight.exr", "--spp", std::to_string(samples)}).exit_code, 0);
  expect_same_light("ball.exr", "straight.exr");
}

TEST_F(RenderInterrupted, DoesNotGoOnWithAnotherScene) {
  ASSERT_EQ(interrupt().exit_code, 130);
  const std::string state = shop.content("ball.state.exr"), picture = shop.content("ball.exr");
  const auto expect_refused = [&](const std::string& what, const Words& more) {
    const Ran ran = resume(5, more);
    EXPECT_EQ(ran.exit_code, 3) << what;
    EXPECT_NE(ran.error.find("ball.state.exr: the state of another scene, camera or setting (delete it"),
              std::string::npos)
        << what << ": " << ran.error;
    EXPECT_TRUE(shop.content("ball.state.exr") == state) << what;
    EXPECT_TRUE(shop.content("ball.exr") == picture) << what;
  };
  expect_refused("seed", {"--seed", "1"});
  expect_refused("camera", {"--camera", "side"});
  expect_refused("size", {"--size", "16x16"});
  expect_refused("bounces", {"--bounces", "2"});
  expect_refused("layers", {"--layers"});
  expect_refused("force", {"--force", "all"});
  shop.write_ball("ball.json", "\"roughness\": 0.4", "\"roughness\": 0.5");
  expect_refused("material", {});
  shop.write_ball("ball.json", "\"strength\": 20", "\"strength\": 21");
  expect_refused("light", {});
  shop.write_ball("ball.json", "\"radiance\": [0.1,", "\"radiance\": [0.2,");
  expect_refused("environment", {});
  // What does not change the samples may change.
  shop.write_ball("ball.json", "\"name\": \"lamp\"", "\"name\": \"sun\"");
  EXPECT_EQ(resume(samples_in("ball.exr") + 1, {"--ev", "1"}).exit_code, 0);
}

TEST_F(RenderInterrupted, RefusesAStateThatIsNone) {
  const auto refused = [&](const std::string& what) {
    const Ran ran = resume(5);
    EXPECT_EQ(ran.exit_code, 3) << what;
    EXPECT_NE(ran.error.find("ball.state.exr"), std::string::npos) << ran.error;
    EXPECT_EQ(std::count(ran.error.begin(), ran.error.end(), '\n'), 1) << ran.error;
  };
  files::write_whole(shop / "ball.state.exr", "");
  refused("empty");
  files::write_whole(shop / "ball.state.exr", "Tyger Tyger, burning bright");
  refused("poem");
  ASSERT_EQ(shop.run({"render", "ball.json", "--spp", "1", "--out", "other.exr", "--no-png"}).exit_code, 0);
  files::write_whole(shop / "ball.state.exr", shop.content("other.exr"));
  refused("a picture");
  std::filesystem::remove(shop / "ball.state.exr");
  ASSERT_EQ(interrupt().exit_code, 130);
  const std::string state = shop.content("ball.state.exr");
  files::write_whole(shop / "ball.state.exr", state.substr(0, state.size() / 2));
  refused("half");
}

TEST_F(RenderInterrupted, BeginsAnewWithoutResumeAndSaysSo) {
  ASSERT_EQ(interrupt().exit_code, 130);
  const Ran anew = shop.run({"render", "ball.json", "--spp", "2", "--json"});
  EXPECT_EQ(anew.exit_code, 0);
  EXPECT_NE(anew.error.find("--resume"), std::string::npos) << anew.error;
  EXPECT_EQ(Json::parse(anew.out).at("samples"), 2);
  EXPECT_FALSE(std::filesystem::exists(shop / "ball.state.exr"));
  const Ran nothing = resume(2);
  EXPECT_EQ(nothing.exit_code, 0);
  EXPECT_NE(nothing.error.find("nothing to resume"), std::string::npos) << nothing.error;
}

TEST_F(RenderInterrupted, EndsAtOnceBySecondSignalWithoutHalfAFile) {
  const pid_t child = shop.start({"render", "ball.json", "--spp", kForever, "--size", "1024x1024", "--layers"});
  for (int i = 0; i < 3000 && test::cpu_seconds_of(child) < 0.4; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ::kill(child, SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ::kill(child, SIGINT);
  const Ran ran = shop.wait_for(child);
  EXPECT_TRUE(ran.exit_code == -SIGINT || ran.exit_code == 130) << ran.exit_code;
  for (const std::string& name : shop.files())
    if (name.ends_with(".exr") && !name.starts_with(".")) {
      EXPECT_NO_THROW(image::read_layers(shop / name)) << name;
    }
}

}  // namespace
}  // namespace likeness::render_command
