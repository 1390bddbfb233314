#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <set>
#include <thread>
#include <vector>
#include <nlohmann/json.hpp>

#include "fit/fit.h"
#include "render/files/files.h"
#include "render/material/material_file.h"
#include "tests/fit/known_materials.h"

// `likeness fit` as a user runs it: the built program, files and folders.
namespace likeness::fit {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

struct Ran {
  int exit_code = -1;  // minus the signal, if one ended it
  std::string out, error;
};

pid_t start(const Words& words, const fs::path& out, const fs::path& error) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  std::vector<char*> arguments;
  static std::string program = LIKENESS_PROGRAM, fit = "fit";
  arguments.push_back(program.data());
  arguments.push_back(fit.data());
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  for (const auto& [file, descriptor] : {std::pair{out, 1}, std::pair{error, 2}})
    ::dup2(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), descriptor);
  ::execv(program.c_str(), arguments.data());
  ::_exit(127);
}

int wait_for(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

class FitCommand : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }

  Ran run(const Words& words) const {
    Ran ran;
    ran.exit_code = wait_for(start(words, folder / ".out", folder / ".error"));
    ran.out = read(folder / ".out");
    ran.error = read(folder / ".error");
    return ran;
  }
  static std::string read(const fs::path& file) { return files::read_whole(file, 100'000'000); }

  // A small material with known parameters: 30 x 30 x 30 directions, 1 MB.
  static std::string small(std::uint64_t seed) {
    datasets_synthetic::Material m{datasets_synthetic::drawn(brdf::Callisto<double>{}, seed), {}, {}, seed};
    m.grid = datasets_synthetic::grid_of(measured::Format::kMbsdf, 30, 30);
    return datasets_synthetic::make(m).bytes;
  }
  fs::path make_batch(int count) const {
    const fs::path in = folder / "in";
    for (int i = 0; i < count; ++i)
      files::write_whole(in / ("material_" + std::to_string(i) + ".mbsdf"), small(static_cast<std::uint64_t>(i) + 1));
    return in;
  }
  Words quick(const fs::path& in, const fs::path& out, const Words& more = {}) const {
    Words words{in.string(), "--out", out.string(), "--starts", "3"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  const fs::path folder = fs::path(testing::TempDir()) / ("likeness_fit_" + std::to_string(::getpid()));
};

// Without the times that a run took.
Json timeless(Json j) {
  if (j.is_object()) {
    j.erase("cpu_seconds");
    for (auto& [key, value] : j.items()) value = timeless(value);
  } else if (j.is_array()) {
    for (auto& value : j) value = timeless(value);
  }
  return j;
}

// Every result of a folder, without times; fails on anything that is no whole file of a known kind.
std::map<std::string, std::string> results_in(const fs::path& folder) {
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(".")) continue;  // of a killed run: no reader takes it for a file of its own
    const std::string bytes = files::read_whole(entry.path(), 100'000'000);
    if (name.ends_with(".fit.json")) {
      out[name] = timeless(Json::parse(bytes)).dump();
    } else if (name.ends_with(".material.json")) {
      material::material_of(bytes, name);
      out[name] = bytes;
    } else {
      EXPECT_TRUE(name.ends_with(".html")) << name;
      EXPECT_NE(bytes.find("</html>"), std::string::npos) << name << " is a part of a file";
    }
  }
  return out;
}

std::string result_of(const fs::path& file) {
  return timeless(Json::parse(files::read_whole(file, 100'000'000))).dump();
}

TEST_F(FitCommand, TheNumbersDoNotDependOnThreadsNorOnWhatElseIsFitted) {
  const fs::path in = make_batch(4);
  const fs::path one = in / "material_2.mbsdf";
  ASSERT_EQ(run({one.string(), "--out", folder / "1", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(run({one.string(), "--out", folder / "4", "--threads", "4"}).exit_code, 0);
  ASSERT_EQ(run({one.string(), "--out", folder / "again", "--threads", "4"}).exit_code, 0);
  ASSERT_EQ(run({in.string(), "--out", folder / "batch", "--threads", "3"}).exit_code, 0);
  const std::string want = result_of(folder / "1/material_2.fit.json");
  for (const char* other : {"4", "again", "batch"}) {
    EXPECT_EQ(result_of(folder / other / "material_2.fit.json"), want) << other;
    EXPECT_EQ(read(folder / other / "material_2.material.json"), read(folder / "1/material_2.material.json")) << other;
  }
}

// Over a whole table the sums run in chunks on all threads.
TEST_F(FitCommand, TheNumbersOfATableDoNotDependOnThreads) {
  datasets_synthetic::Faults noise;
  noise.noise = 0.05;
  datasets_synthetic::Material m{brdf::Disney2012<double>{}, {}, noise, 1};
  m.grid = datasets_synthetic::grid_of(measured::Format::kMbsdf, 60, 60);  // 216,000 samples: four chunks
  files::write_whole(folder / "a.mbsdf", datasets_synthetic::make(m).bytes);
  for (const char* threads : {"1", "4"})
    ASSERT_EQ(run({folder / "a.mbsdf", "--on", "table", "--tier", "base", "--starts", "1", "--threads", threads,
                   "--out", folder / threads})
                  .exit_code,
              0);
  EXPECT_EQ(result_of(folder / "4/a.fit.json"), result_of(folder / "1/a.fit.json"));
}

TEST_F(FitCommand, ABatchGoesPastBadFilesAndListsThemAtTheEnd) {
  const fs::path in = make_batch(2);
  files::write_whole(in / "empty.binary", "");
  files::write_whole(in / "short.binary", test::merl_bytes_of(brdf::Lambert<double>{}).substr(0, 1'000'000));
  files::write_whole(in / "text.mbsdf", "this is not a material\n");
  datasets_synthetic::Faults nothing;
  nothing.invalid = 1;
  files::write_whole(in / "invalid.binary", test::merl_bytes_of(brdf::Lambert<double>{}, nothing));
  files::write_whole(in / "few.csv", "theta_i,theta_o,phi,r,g,b\n0.1,0.2,0.3,1,1,1\n");
  const Ran ran = run(quick(in, folder / "out"));
  EXPECT_EQ(ran.exit_code, 3);
  for (const char* bad : {"empty.binary", "short.binary", "text.mbsdf", "invalid.binary", "few.csv"}) {
    const auto end = ran.error.rfind(bad);
    EXPECT_NE(end, std::string::npos) << bad;
    EXPECT_GT(end, ran.error.rfind("7/7")) << bad << " is not in the list at the end";
    EXPECT_FALSE(fs::exists(folder / "out" / (fs::path(bad).stem().string() + ".fit.json"))) << bad;
  }
  for (const char* good : {"material_0", "material_1"})
    for (const char* kind : {".fit.json", ".material.json", ".html"})
      EXPECT_TRUE(fs::exists(folder / "out" / (std::string(good) + kind))) << good << kind;
  EXPECT_TRUE(fs::exists(folder / "out/index.html"));
  EXPECT_NE(read(folder / "out/index.html").find("short.binary"), std::string::npos);

  const Ran json = run(quick(in, folder / "out", {"--json"}));
  EXPECT_EQ(json.exit_code, 3);
  const Json summary = Json::parse(json.out);
  EXPECT_EQ(summary.at("materials").size(), 2u);
  EXPECT_EQ(summary.at("failed").size(), 5u);
  EXPECT_EQ(summary.at("taken_over"), 2);
  for (const Json& m : summary.at("materials")) EXPECT_TRUE(fs::exists(m.at("result").get<std::string>()));

  const Ran single = run(quick(in / "short.binary", folder / "single"));
  EXPECT_EQ(single.exit_code, 3);
  EXPECT_EQ(std::ranges::count(single.error, '\n'), 1) << single.error;
  EXPECT_FALSE(fs::exists(folder / "single/short.fit.json"));
}

// Whenever a batch is stopped, and however: what was finished is kept, nothing is half there, and the same command
// ends where an undisturbed run ends.
TEST_F(FitCommand, AStoppedBatchResumes) {
  const fs::path in = make_batch(5);
  const auto began = std::chrono::steady_clock::now();
  ASSERT_EQ(run(quick(in, folder / "whole")).exit_code, 0);
  const auto whole = std::chrono::steady_clock::now() - began;
  const auto want = results_in(folder / "whole");
  ASSERT_EQ(want.size(), 10u);
  int unfinished = 0;
  for (const int signal : {SIGKILL, SIGINT, SIGTERM})
    for (const int tenths : {3, 6}) {
      if (signal != SIGKILL && tenths != 3) continue;  // both ask it to end
      SCOPED_TRACE("signal " + std::to_string(signal) + " after " + std::to_string(tenths) + " tenths");
      const fs::path out = folder / ("out_" + std::to_string(signal) + "_" + std::to_string(tenths));
      const pid_t child = start(quick(in, out), folder / ".out", folder / ".error");
      std::this_thread::sleep_for(whole * tenths / 10);
      ::kill(child, signal);
      const int code = wait_for(child);
      if (code == 0) continue;  // it was faster this time
      ++unfinished;
      EXPECT_EQ(code, signal == SIGKILL ? -SIGKILL : 130);
      std::map<std::string, fs::file_time_type> finished;
      if (fs::exists(out)) {
        for (const auto& [name, bytes] : results_in(out)) {
          EXPECT_EQ(bytes, want.at(name));
          if (name.ends_with(".fit.json")) finished[name] = fs::last_write_time(out / name);
        }
      }
      const Ran again = run(quick(in, out, {"--json"}));
      EXPECT_EQ(again.exit_code, 0) << again.error;
      EXPECT_GE(Json::parse(again.out).at("taken_over").get<std::size_t>(), finished.size());
      for (const auto& [name, time] : finished) EXPECT_EQ(fs::last_write_time(out / name), time) << name;
      EXPECT_EQ(results_in(out), want);
    }
  EXPECT_GE(unfinished, 2) << "too few runs were stopped in the middle to say anything";
}

TEST_F(FitCommand, ChangedOptionsInputsOrDamagedResultsAreFittedAgain) {
  const fs::path in = make_batch(2), out = folder / "out";
  ASSERT_EQ(run(quick(in, out)).exit_code, 0);
  const auto taken = [&](const Words& words) {
    const Ran ran = run(words);
    EXPECT_EQ(ran.exit_code, 0) << ran.error;
    return Json::parse(ran.out).at("taken_over").get<int>();
  };
  EXPECT_EQ(taken(quick(in, out, {"--json"})), 2);
  EXPECT_EQ(taken(quick(in, out, {"--json", "--threads", "1"})), 2) << "threads do not change the numbers";
  EXPECT_EQ(taken(quick(in, out, {"--json", "--cut", "75"})), 0);
  EXPECT_EQ(taken(quick(in, out, {"--json", "--loss", "cuberoot"})), 0);
  EXPECT_EQ(taken(quick(in, out, {"--json", "--tier", "base"})), 0);
  EXPECT_EQ(taken(quick(in, out, {"--json"})), 0) << "the results there were of another tier";
  files::write_whole(in / "material_0.mbsdf", small(99));
  EXPECT_EQ(taken(quick(in, out, {"--json"})), 1);
  EXPECT_EQ(taken(quick(in, out, {"--json"})), 2);
  const std::string whole = read(out / "material_1.fit.json");
  files::write_whole(out / "material_1.fit.json", whole.substr(0, whole.size() / 2));
  EXPECT_EQ(taken(quick(in, out, {"--json"})), 1) << "a cut result file";
  fs::remove(out / "material_1.html");
  EXPECT_EQ(taken(quick(in, out, {"--json"})), 1) << "a missing report";
  EXPECT_TRUE(fs::exists(out / "material_1.html"));
  std::string older = read(out / "material_1.fit.json");
  const std::string version = std::string("\"version\": \"") + LIKENESS_VERSION;
  older.replace(older.find(version), version.size(), "\"version\": \"0.0.1");
  files::write_whole(out / "material_1.fit.json", older);
  EXPECT_EQ(taken(quick(in, out, {"--json"})), 1) << "a result of another version";
}

TEST_F(FitCommand, NamesStayApartAndSurviveAnyCharacter) {
  const std::string bytes = small(1);
  for (const char* name : {"a/gold.mbsdf", "b/gold.mbsdf", "with space.mbsdf", "it's \"quoted\".mbsdf",
                           "gl\xc3\xa4nzend.mbsdf", "a<b>&c.mbsdf", "$HOME;echo.mbsdf"})
    files::write_whole(folder / "in" / name, bytes);
  datasets_synthetic::Material m{brdf::Lambert<double>{}, {}, {}, 1};
  m.grid = datasets_synthetic::grid_of(measured::Format::kCsv, 12, 12);
  files::write_whole(folder / "in/a/gold.csv", datasets_synthetic::make(m).bytes);
  const Ran ran = run(quick(folder / "in", folder / "out", {"--json"}));
  ASSERT_EQ(ran.exit_code, 0) << ran.error;
  const Json summary = Json::parse(ran.out);
  EXPECT_EQ(summary.at("materials").size(), 8u);
  std::set<std::string> names;
  for (const Json& material : summary.at("materials")) {
    names.insert(material.at("material").get<std::string>());
    EXPECT_TRUE(fs::exists(material.at("report").get<std::string>())) << material.at("report");
  }
  EXPECT_EQ(names.size(), 8u);
  EXPECT_TRUE(names.contains("with space") && names.contains("it's \"quoted\"") && names.contains("a<b>&c"));
  const std::string page = read(folder / "out/index.html");
  EXPECT_EQ(page.find("a<b>"), std::string::npos) << "a name reaches the page without being escaped";
  EXPECT_NE(page.find("a&lt;b&gt;"), std::string::npos);
}

TEST_F(FitCommand, EveryUnusableOptionIsNamedWithWhatIsAllowed) {
  files::write_whole(folder / "a.mbsdf", small(1));
  const std::string file = folder / "a.mbsdf";
  struct Row {
    Words words;
    int exit_code;
    const char *names, *allows;
  };
  const Row rows[] = {
      {{}, 2, "FILE", "--help"},
      {{folder / "absent.binary"}, 3, "absent.binary", "expected"},
      {{folder / "none"}, 3, "none", "expected"},
      {{file, "--model", "calisto"}, 2, "--model calisto", "callisto"},
      {{file, "--model", "qqqqqqqq"}, 2, "--model qqqqqqqq", "callisto"},
      {{file, "--tier", "richest"}, 2, "--tier richest", "base, advanced, full"},
      {{file, "--model", "ggx", "--tier", "base"}, 2, "--tier base", "leave the option out"},
      {{file, "--on", "sphere"}, 2, "--on sphere", "slice, table"},
      {{file, "--loss", "square"}, 2, "--loss square", "log, cuberoot"},
      {{file, "--cut", "100"}, 2, "--cut 100", "[20, 90]"},
      {{file, "--cut", "nan"}, 2, "--cut", "[20, 90]"},
      {{file, "--cut", "wide"}, 2, "--cut", "--help"},
      {{file, "--starts", "-1"}, 2, "--starts -1", "[0, 100000]"},
      {{file, "--starts", "1.5"}, 2, "--starts", "--help"},
      {{file, "--threads", "-2"}, 2, "--threads -2", "[0, 1024]"},
      {{file, "--thread", "2"}, 2, "--thread", "--threads"},
      {{file, "--out"}, 2, "--out", "--help"},
  };
  fs::create_directories(folder / "none");
  for (const Row& row : rows) {
    const Ran ran = run(row.words);
    const std::string what = row.words.empty() ? "" : row.words.back();
    EXPECT_EQ(ran.exit_code, row.exit_code) << what << ": " << ran.error;
    EXPECT_NE(ran.error.find(row.names), std::string::npos) << ran.error;
    EXPECT_NE(ran.error.find(row.allows), std::string::npos) << what << ": " << ran.error;
    EXPECT_EQ(std::ranges::count(ran.error, '\n'), 1) << ran.error;
    EXPECT_EQ(ran.out, "") << what;
  }
}

// Root may write anywhere, so the folder is one that cannot be: a file stands in its place.
TEST_F(FitCommand, AnOutputFolderThatCannotBeWrittenIsSaidInOneLine) {
  files::write_whole(folder / "a.mbsdf", small(1));
  files::write_whole(folder / "taken", "a file\n");
  const Ran ran = run(quick(folder / "a.mbsdf", folder / "taken"));
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_NE(ran.error.find("cannot be written"), std::string::npos) << ran.error;
  EXPECT_EQ(std::ranges::count(ran.error, '\n'), 1) << ran.error;
  EXPECT_EQ(read(folder / "taken"), "a file\n");
}

TEST_F(FitCommand, TheResultFileHoldsWhatAFitOwes) {
  files::write_whole(folder / "a.mbsdf", small(3));
  const Ran ran = run({folder / "a.mbsdf", "--out", folder / "out", "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.error;
  EXPECT_EQ(timeless(Json::parse(ran.out)), timeless(Json::parse(read(folder / "out/a.fit.json"))));
  const Json j = Json::parse(ran.out);
  EXPECT_EQ(j.at("version"), LIKENESS_VERSION);
  EXPECT_EQ(j.at("material"), "a");
  EXPECT_EQ(j.at("input").at("file"), (folder / "a.mbsdf").string());
  // sha256sum of coreutils as the oracle.
  const std::string sum = "sha256sum '" + (folder / "a.mbsdf").string() + "' > '" + (folder / ".sum").string() + "'";
  ASSERT_EQ(std::system(sum.c_str()), 0);
  EXPECT_EQ(j.at("input").at("sha256"), read(folder / ".sum").substr(0, 64));
  EXPECT_EQ(j.at("options").at("cut_deg"), 80);
  EXPECT_EQ(j.at("options").at("model"), "callisto");
  const auto rows = brdf::Callisto<double>::kParameters;
  const Json& parameters = j.at("best").at("parameters");
  ASSERT_EQ(parameters.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Json& p = parameters[i];
    EXPECT_EQ(p.at("name"), rows[i].name);
    EXPECT_EQ(p.at("unit"), rows[i].unit);
    EXPECT_EQ(p.at("bounds")[0], rows[i].range.low);
    EXPECT_EQ(p.at("bounds")[1], rows[i].range.high);
    for (const char* field : {"tier", "value", "sigma", "matters", "at_bound", "fitted"})
      EXPECT_TRUE(p.contains(field)) << field;
    EXPECT_EQ(p.at("value").is_array(), rows[i].channels == 3);
  }
  for (const char* metric : {"slice_error_pct", "slice_log_rms", "log_rms_3d", "albedo_error", "sphere_psnr_db",
                             "sphere_ssim", "slice_samples", "slice_grid", "table_samples", "table_stored"})
    EXPECT_TRUE(j.at("best").at("metrics").contains(metric)) << metric;
  EXPECT_GE(j.at("baselines").size(), 4u);
  EXPECT_TRUE(j.contains("pattern"));

  // The material file is the result, to the last bit.
  const auto back = material::read_material(folder / "out/a.material.json");
  EXPECT_EQ(back.name, "a");
  const auto values = brdf::channels_of(std::get<brdf::Callisto<double>>(back.brdf));
  std::size_t at = 0;
  for (const Json& p : parameters) {
    if (p.at("value").is_array())
      for (const Json& v : p.at("value")) EXPECT_EQ(v.get<double>(), values[at++]) << p.at("name");
    else EXPECT_EQ(p.at("value").get<double>(), values[at++]) << p.at("name");
  }
}

TEST_F(FitCommand, AModelThatIsNotFittedIsRefusedWithThoseThatAre) {
  files::write_whole(folder / "a.mbsdf", small(2));
  const Ran ran = run(quick(folder / "a.mbsdf", folder / "out", {"--model", "callisto_proxima"}));
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_EQ(
      ran.error,
      "likeness fit: --model callisto_proxima is a model that is not fitted; those that are: callisto, disney2012, "
      "ggx, lambert, burley_diffuse, oren_nayar, oren_nayar_1994, proxima\n");
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(FitCommand, EveryModelAndTierFits) {
  files::write_whole(folder / "a.mbsdf", small(2));
  for (const std::string_view model : fitted_models()) {
    const Ran ran = run(quick(folder / "a.mbsdf", folder / model, {"--model", std::string(model), "--json"}));
    ASSERT_EQ(ran.exit_code, 0) << model << ": " << ran.error;
    EXPECT_EQ(Json::parse(ran.out).at("best").at("model"), model);
  }
  double last = 1e300;
  for (const char* tier : {"base", "advanced", "full"}) {
    const Ran ran = run(quick(folder / "a.mbsdf", folder / tier, {"--tier", tier, "--json"}));
    ASSERT_EQ(ran.exit_code, 0) << tier << ": " << ran.error;
    const double loss = Json::parse(ran.out).at("best").at("loss");
    EXPECT_LE(loss, last) << tier;
    last = loss;
  }
}

}  // namespace
}  // namespace likeness::fit
