#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/render/temporary_folder.h"

extern char** environ;

// likeness realis as its users meet it: real processes on a small capture that was made for them.
namespace likeness::realis {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct Outcome {
  int exit_code = -1;  // -1: ended by a signal
  std::string out, err;
};

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Once for all tests: a ball under 6 lights, baked.
class RealisCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    ASSERT_EQ(run("make capture ball --lights 6 --size 24x24").exit_code, 0);
    ASSERT_EQ(run("realis bake ball --lobes 4").exit_code, 0);
  }
  static void TearDownTestSuite() { delete folder_; }

  static fs::path path(const std::string& name) { return *folder_ / name; }

  static Outcome run(const std::string& arguments) {
    const std::string command = "cd '" + folder_->path().string() + "' && timeout 60 '" LIKENESS_PROGRAM "' " +
                                arguments + " </dev/null >'" + path("stdout").string() + "' 2>'" +
                                path("stderr").string() + "'";
    const int status = std::system(command.c_str());  // NOLINT(bugprone-command-processor,cert-env33-c): our own words
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(path("stdout")), content(path("stderr"))};
  }

  // A refusal is the exit code, nothing on stdout, and one line on stderr that holds each of the words.
  static void expect_refusal(const std::string& arguments, int exit_code, const std::vector<std::string>& words) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << arguments << "\n" << outcome.err;
    for (const std::string& word : words)
      EXPECT_NE(outcome.err.find(word), std::string::npos) << arguments << "\nsaid: " << outcome.err << "not: " << word;
  }

  static std::vector<std::string> files_below(const std::string& name) {
    std::vector<std::string> out;
    if (fs::exists(path(name)))
      for (const auto& entry : fs::recursive_directory_iterator(path(name)))
        if (entry.is_regular_file()) out.push_back(fs::relative(entry.path(), path(name)).string());
    std::ranges::sort(out);
    return out;
  }

  inline static test::TemporaryFolder* folder_ = nullptr;
};

TEST_F(RealisCommand, HelpTeachesWithExamplesAndExitCodes) {
  for (const std::string verb : {"bake", "apply", "report", "export"}) {
    const Outcome help = run("realis " + verb + " --help");
    EXPECT_EQ(help.exit_code, 0);
    for (const std::string& word : {std::string("Examples"), "  likeness realis " + verb, std::string("Exit codes: 0")})
      EXPECT_NE(help.out.find(word), std::string::npos) << verb << ": " << word;
  }
}

// The examples of the page of export, as they are printed.
TEST_F(RealisCommand, TheExamplesOfExportRun) {
  fs::create_directories(path("examples"));
  fs::copy(path("ball"), path("examples/capture"), fs::copy_options::recursive);
  const std::string help = run("realis export --help").out;
  int count = 0;
  for (std::size_t at = 0; (at = help.find("\n  likeness realis export", at)) != help.npos; ++at) {
    std::string line = help.substr(at + 3, help.find('\n', at + 1) - at - 3);
    line = line.substr(std::string("likeness ").size(), line.find("    ") - std::string("likeness ").size());
    const std::string command = "cd examples && '" LIKENESS_PROGRAM "' " + line + " >/dev/null";
    EXPECT_EQ(std::system(("cd '" + folder_->path().string() + "' && " + command).c_str()), 0) << line;  // NOLINT
    ++count;
  }
  EXPECT_EQ(count, 3);
}

TEST_F(RealisCommand, WhatIsNotThereIsNamedWithTheWayOut) {
  for (const std::string verb : {"bake", "apply --light 0,0,1", "report", "export --out x"})
    expect_refusal("realis " + verb + " nothing", 3, {"nothing"});
  expect_refusal("realis bake ball --camera c1", 2, {"--camera", "\"c1\"", "did you mean", "c0"});
  expect_refusal("realis bake ball --variant path", 2, {"--variant", "\"path\"", "likeness olat render"});
  expect_refusal("realis report ball --variant path", 2, {"--variant", "\"path\""});
  expect_refusal("realis bake ball --without shadw", 2, {"shadw", "shadow"});
  expect_refusal("realis apply ball --light 0,0,1 --name nobody", 3, {"nobody"});
  expect_refusal("realis export ball --out x --name nobody", 2, {"nobody", "likeness realis bake"});
  expect_refusal("realis export ball --out x --format lp --camera c1", 2, {"\"c1\"", "c0"});
  expect_refusal("realis exprt ball", 2, {"exprt", "did you mean export"});
}

TEST_F(RealisCommand, WhatCannotBeSaysWhatIsAllowed) {
  for (const std::string lobes : {"0", "257", "1.5", "many", "-3"})
    expect_refusal("realis bake ball --lobes " + lobes, 2, {"--lobes", lobes, "256"});
  expect_refusal("realis bake ball --floor 0", 2, {"--floor", "(0, 1]"});
  expect_refusal("realis apply ball", 2, {"--light", "--environment"});
  expect_refusal("realis apply ball --light 1,2", 2, {"--light", "1,2", "x,y,z"});
  expect_refusal("realis apply ball --light 0,0,0", 2, {"--light"});
  expect_refusal("realis export ball --out x --format hsx", 2, {"hsx", "lp, ptm, hsh, bilinear, rbf"});
  expect_refusal("realis export ball --out x --lights 15", 2, {"--lights", "15", "16"});
  expect_refusal("realis export ball --out x --lights 4097", 2, {"--lights", "4096"});
  expect_refusal("realis export ball --out x --format ptm --lights photographs", 2, {"--lights", "planes"});
  expect_refusal("realis export ball --out x --ev bright", 2, {"--ev", "auto"});
  expect_refusal("realis export ball --out x --quality 101", 2, {"--quality", "100"});
  EXPECT_FALSE(fs::exists(path("x"))) << "refused before anything is written";
}

TEST_F(RealisCommand, ABakeThatIsDamagedIsAFileThatCannotBeUsed) {
  fs::copy(path("ball"), path("torn"), fs::copy_options::recursive);
  const std::string whole = content(path("torn/realis/bake/bake.json"));
  std::ofstream(path("torn/realis/bake/bake.json"), std::ios::binary) << whole.substr(0, whole.size() / 2);
  for (const std::string verb : {"apply torn --light 0,0,1", "export torn --out x"})
    expect_refusal("realis " + verb, 3, {"bake.json"});
  std::ofstream(path("torn/realis/bake/bake.json"), std::ios::binary) << whole;
  fs::remove(path("torn/realis/bake/coefficients_000.png"));
  for (const std::string verb : {"apply torn --light 0,0,1", "export torn --out x"})
    expect_refusal("realis " + verb, 3, {"coefficients_000.png"});
  EXPECT_FALSE(fs::exists(path("x")));
}

TEST_F(RealisCommand, ExportDoesNotWriteOverWhatIsThere) {
  fs::create_directories(path("full"));
  std::ofstream(path("full/mine.txt")) << "mine";
  expect_refusal("realis export ball --out full", 2, {"full", "--overwrite"});
  expect_refusal("realis export ball --out full/mine.txt", 2, {"is a file"});
  EXPECT_EQ(run("realis export ball --out full --overwrite --lights 16").exit_code, 0);
  EXPECT_EQ(content(path("full/mine.txt")), "mine");
}

// /dev/full takes no byte; the folder for files cannot be made where a file is.
TEST_F(RealisCommand, AFolderThatCannotBeWrittenIsSaidInOneLine) {
  expect_refusal("realis export ball --out /proc/self/web --lights 16", 4, {"/proc/self/web"});
}

TEST_F(RealisCommand, JsonIsValidAndAlone) {
  for (const std::string words : {"export ball --out j1 --json", "export ball --format lp --out j2 --json",
                                  "report ball --texels 40 --no-rgb --no-bake --out j3 --json"}) {
    const Outcome outcome = run("realis " + words);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(Json::accept(outcome.out)) << words << outcome.out;
  }
  const Json planes = Json::parse(run("realis export ball --out j4 --format hsh --json").out);
  EXPECT_EQ(planes["planes"], 27);
  EXPECT_GT(planes["psnr_db"], 15);
  const Json info = Json::parse(content(path("j4/info.json")));
  EXPECT_EQ(info["type"], "hsh");
  EXPECT_EQ(info["width"], 24);
  EXPECT_EQ(info["materials"][0]["scale"].size(), 27u);
}

// Out to RTI programs and in again: the same lights in the same order, and the mask.
TEST_F(RealisCommand, ExportedPicturesAreImportedAgain) {
  ASSERT_EQ(run("realis export ball --format lp --out rti").exit_code, 0);
  EXPECT_EQ(run("olat import rti --color-space srgb --out again").exit_code, 0);
  const Json lights = Json::parse(content(path("again/lights.json")))["lights"];
  EXPECT_EQ(lights.size(), 6u);
  const std::vector<std::string> files = files_below("rti");
  EXPECT_NE(std::ranges::find(files, "mask.png"), files.end());
  EXPECT_EQ(content(path("rti/lights.lp")).substr(0, 2), "6\n");
  // The light of the list is the one that apply is asked for: x right, y up, z to the camera.
  std::istringstream list(content(path("rti/lights.lp")));
  std::string count, name, x, y, z;
  list >> count >> name >> x >> y >> z;
  ASSERT_EQ(run("realis export ball --format lp --lights capture --png --ev 0 --out relit").exit_code, 0);
  ASSERT_EQ(run("realis apply ball --light " + x + "," + y + "," + z + " --view srgb --out one.exr").exit_code, 0);
  const std::string stem = fs::path(name).stem().string();
  EXPECT_EQ(content(path("relit/" + stem + ".png")), content(path("one.png"))) << "light " << stem;
}

TEST_F(RealisCommand, OneLightIsEnoughToExport) {
  ASSERT_EQ(run("make capture single --lights 1 --size 16x16").exit_code, 0);
  const Outcome baked = run("realis bake single --lobes 1");
  ASSERT_EQ(baked.exit_code, 0) << baked.err;
  for (const std::string format : {"lp", "ptm", "hsh", "bilinear", "rbf"})
    EXPECT_EQ(run("realis export single --lights 16 --format " + format + " --out single_" + format).exit_code, 0);
  EXPECT_EQ(run("realis export single --format lp --out single_photographs").exit_code, 0);
}

// Two commands from photographs to a page, the second of them alone here: it bakes what is not baked.
TEST_F(RealisCommand, TheReportBakesAndWritesAPageToRelight) {
  ASSERT_EQ(run("make capture fresh --lights 6 --size 20x20").exit_code, 0);
  const Outcome outcome = run("realis report fresh --texels 40 --no-rgb");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("relight.html"), std::string::npos);
  EXPECT_TRUE(fs::exists(path("fresh/realis/bake/bake.json")));
  EXPECT_NE(content(path("fresh/realis/report/report.html")).find("href=\"relight.html\""), std::string::npos);
  EXPECT_NE(content(path("fresh/realis/report/relight.html")).find("data:image/jpeg;base64,"), std::string::npos);
  // The words beside a way bake it.
  int baked = 0;
  const Json report = Json::parse(content(path("fresh/realis/report/report.json")));
  for (const Json& row : report.at("rows")) {
    EXPECT_EQ(row.contains("bake_words"), row.at("family") == "realis") << row.at("name");
    const std::string name = row.at("name");
    if (name != "render + 4 mixes luminance, 4 bit" && name != "render + 8 lobes luminance") continue;
    const Outcome again =
        run("realis bake fresh --json --result '' --name again " + row.at("bake_words").get<std::string>());
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(Json::parse(again.out).at("bytes_of_texel").get<int>() + 5, row.at("bytes").get<int>()) << name;
    ++baked;
  }
  EXPECT_EQ(baked, 2);
}

// A mesh in its own texture, as docs/realis_mesh.md has it: what was photographed is brighter than what is rendered.
TEST_F(RealisCommand, AMeshIsBakedFromItsSceneAndSaysSo) {
  const auto scene = [](const std::string& name, const std::string& color) {
    std::ofstream(path(name)) << R"({"format": "likeness scene", "version": 1,
      "meshes": {"board": {"shape": "plane", "size": 0.3}},
      "materials": {"paint": {"parameters": {"roughness": 1, "base_color": )"
                              << color << R"(}}},
      "instances": [{"name": "board", "mesh": "board", "material": "paint"}]})";
  };
  scene("photographed.json", "[0.6, 0.4, 0.2]"), scene("board.json", "[0.3, 0.2, 0.1]");
  ASSERT_EQ(run("make capture mesh --template --lights 12 --cameras 2 --size 40x40").exit_code, 0);
  ASSERT_EQ(run("olat render mesh --scene photographed.json --integrator runtime --spp 1 --variant photos").exit_code,
            0);
  ASSERT_EQ(run("olat render mesh --scene board.json --integrator runtime --spp 1").exit_code, 0);
  const Outcome outcome = run("realis bake mesh --scene board.json --object board --resolution 16 --lobes 8 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json bake = Json::parse(content(path("mesh/realis/bake/bake.json")));
  EXPECT_EQ(bake.at("space"), "texture");
  EXPECT_FALSE(fs::exists(path("mesh/realis/bake/work"))) << "what is kept between steps is removed";
  const Json said = Json::parse(outcome.out);
  EXPECT_LT(said.at("realis_rms").get<double>(), 0.5 * said.at("render_rms").get<double>()) << outcome.out;
  expect_refusal("realis bake mesh --scene board.json --object chair", 2, {"chair", "board"});
  expect_refusal("realis bake mesh --scene board.json --with black", 2, {"black"});
}

// Interrupted as soon as it runs, and again a little later each time until it is done: each time 130 and nothing of the
// folder, or 0 and all of it.
TEST_F(RealisCommand, InterruptedExportsAndBakesLeaveNothingHalf) {
  const auto interrupted_after = [](std::vector<std::string> words, int milliseconds) {
    words.insert(words.begin(), LIKENESS_PROGRAM);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int fd : {1, 2}) posix_spawn_file_actions_addopen(&actions, fd, "/dev/null", O_WRONLY, 0);
    pid_t child = -1;
    EXPECT_EQ(posix_spawn(&child, LIKENESS_PROGRAM, &actions, nullptr, arguments.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(child, SIGINT);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  };
  ASSERT_EQ(run("make capture large --lights 12 --size 64x64").exit_code, 0);
  const std::string large = path("large").string(), web = path("web").string();
  int stopped = 0;
  for (int milliseconds = 30; milliseconds < 2000; milliseconds *= 3) {
    const int code = interrupted_after({"realis", "bake", large, "--result", ""}, milliseconds);
    if (code == 0) break;
    // Before the command catches it, the signal ends the process.
    EXPECT_TRUE(code == 130 || code == -SIGINT) << code;
    stopped += code == 130;
    EXPECT_TRUE(files_below("large/realis/bake").empty()) << milliseconds;
  }
  ASSERT_EQ(run("realis bake large --lobes 8 --result ''").exit_code, 0) << "it can be run again";
  // Planes are written at the end, pictures of an .lp one by one.
  for (const std::string format : {"rbf", "lp"})
    for (int milliseconds = 50; milliseconds < 2000; milliseconds *= 3) {
      const int code = interrupted_after(
          {"realis", "export", large, "--format", format, "--lights", "4096", "--out", web}, milliseconds);
      if (code == 0) break;
      EXPECT_TRUE(code == 130 || code == -SIGINT) << code;
      stopped += code == 130;
      EXPECT_FALSE(fs::exists(web)) << format << " " << milliseconds;
    }
  EXPECT_GT(stopped, 0) << "nothing was interrupted: this test said nothing";
}

}  // namespace
}  // namespace likeness::realis
