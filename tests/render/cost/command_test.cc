#include <algorithm>

#include <gmock/gmock.h>

#include "render/json/json.h"
#include "render/runtime/quality.h"
#include "tests/brdf/eval/program.h"

// `likeness cost SCENE` as a user runs it.
namespace likeness::scene_cost {
namespace {

using eval::test::Program;
using eval::test::Ran;
using testing::HasSubstr;
namespace fs = std::filesystem;

class SceneCost : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    ASSERT_EQ(shell("exec likeness make scene cornell --out box --width 16 --height 16").exit_code, 0);
  }
  Ran cost(const std::string& arguments) const { return shell("exec likeness cost " + arguments); }
  static auto lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }
};

constexpr auto kQuick = "box/scene.json --size 12x12 --reference-spp 4 --repeats 1 --longest-ms 5 --threads 1 ";

TEST_F(SceneCost, WritesEveryOutputAndTheChoice) {
  const Ran ran = cost(std::string(kQuick) + "--out a/b --budget-flip 1 --quality q.json");
  EXPECT_EQ(ran.exit_code, 0) << ran.error;
  EXPECT_THAT(ran.out, HasSubstr("path tracer, 4 spp"));
  EXPECT_THAT(ran.out, HasSubstr("chosen: "));
  EXPECT_THAT(read("a/b/cost.html"), HasSubstr("</html>"));
  EXPECT_THAT(read("a/b/cost.csv"), testing::StartsWith("kind,name,pixel_samples,"));
  const json::Value root = json::parse(read("a/b/cost.json"), "cost.json");
  EXPECT_GE(root.find("rows")->items.size(), 3u);
  EXPECT_EQ(runtime::read_quality(folder / "q.json").pixel_samples, 1) << "the fastest: FLIP is at most 1";

  const Ran again = cost(std::string(kQuick) + "--reference a/b/reference.exr --json");
  EXPECT_EQ(again.exit_code, 0) << again.error;
  EXPECT_EQ(json::parse(again.out, "stdout").find("reference")->find("source")->text, "the file reference.exr");
  const Ran other = cost("box/scene.json --size 13x12 --reference a/b/reference.exr");
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_EQ(lines(other.error), 1) << other.error;
  EXPECT_THAT(other.error, HasSubstr("12 x 12 pixels; the camera's picture has 13 x 12"));
}

TEST_F(SceneCost, SaysThatNothingKeepsToTheBudget) {
  const Ran ran = cost(std::string(kQuick) + "--budget-ms 1e-6 --quality q.json --csv");
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.error, HasSubstr("the fastest is "));
  EXPECT_TRUE(ran.out.starts_with("kind,name"));
  EXPECT_FALSE(fs::exists(folder / "q.json"));
}

TEST_F(SceneCost, RefusesInOneLine) {
  const auto refuses = [&](const std::string& arguments, int exit_code, const std::string& words) {
    const Ran ran = cost(arguments);
    EXPECT_EQ(ran.exit_code, exit_code) << arguments << ran.error;
    EXPECT_EQ(lines(ran.error), 1) << ran.error;
    EXPECT_THAT(ran.error, HasSubstr(words));
    EXPECT_EQ(ran.out, "");
  };
  refuses("", 2, "a scene or evaluators");
  refuses("evaluater", 2, "did you mean likeness cost evaluators?");
  refuses("absent.json", 3, "absent.json");
  refuses("box/scene.json --budget-ms 1 --budget-flip 1", 2, "exclude each other");
  refuses("box/scene.json --quality q.json", 2, "--budget-ms X or --budget-flip X");
  refuses("box/scene.json --camera left", 2, "--camera");
  refuses("box/scene.json --repeats 0", 2, "--repeats");
  refuses("box/scene.json --budget-mss 3", 2, "did you mean --budget-ms?");
  refuses("box/scene.json --reference absent.exr --size 8x8", 3, "absent.exr");
  write("taken", "a file");
  refuses("box/scene.json --out taken", 4, "taken");
}

TEST_F(SceneCost, WritesWhatThereIsWhenItIsInterrupted) {
  const pid_t child = start("exec likeness cost box/scene.json --size 16x16 --reference-spp 1000000 --out stopped");
  ::usleep(700'000);
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 130);
  const std::string error = read(".error");
  EXPECT_THAT(error, HasSubstr("interrupted before anything was measured"));
  EXPECT_THAT(error, HasSubstr("can be given as --reference"));
  EXPECT_TRUE(fs::exists(folder / "stopped/reference.exr"));
  EXPECT_FALSE(fs::exists(folder / "stopped/cost.html"));
}

TEST_F(SceneCost, RenderTakesTheQuality) {
  const auto render = [&](const std::string& more) {
    return shell("exec likeness render box/scene.json --size 12x12 --no-png --json " + more);
  };
  write("q.json", R"({"format": "likeness quality", "version": 1, "settings": {"pixel_samples": 4}})");
  const Ran ran = render("--quality q.json");
  EXPECT_EQ(ran.exit_code, 0) << ran.error;
  const json::Value root = json::parse(ran.out, "stdout");
  EXPECT_EQ(root.find("integrator")->text, "runtime");
  EXPECT_EQ(root.find("samples")->number, 4);
  EXPECT_EQ(render("--quality q.json --integrator runtime").exit_code, 0);
  const Ran other = render("--quality q.json --integrator reference");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.error, HasSubstr("--quality is of the run-time pipeline"));
  write("q.json", "{\"format\": \"likeness quality\", \"version\": 1,\n\"settings\": {\"environment\": \"map\"}}");
  const Ran wrong = render("--quality q.json");
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_EQ(lines(wrong.error), 1);
  EXPECT_THAT(wrong.error, HasSubstr("q.json:2: /settings/environment has no level \"map\""));
  EXPECT_THAT(wrong.error, HasSubstr("did you mean maps?"));
}

TEST_F(SceneCost, HelpTeaches) {
  const Ran ran = cost("--help");
  EXPECT_EQ(ran.exit_code, 0);
  for (const char* word : {"evaluators", "--budget-flip", "--longest-ms", "Examples", "Exit codes"})
    EXPECT_THAT(ran.out, HasSubstr(word));
}

}  // namespace
}  // namespace likeness::scene_cost
