#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

// The program as its users meet it: what it prints, and what it ends with.
namespace likeness::house {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int exit_code = -1;  // -1: ended by a signal
  std::string out, err;
};

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// A folder of this process, empty at first and removed with it.
const fs::path& scratch() {
  static const struct Folder {
    fs::path path = fs::temp_directory_path() / ("likeness_command_line_" + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
  } folder;
  return folder.path;
}

// Runs the program with arguments as a shell would split them.
Outcome run(const std::string& arguments) {
  const fs::path out = scratch() / "stdout", err = scratch() / "stderr";
  const std::string command = "cd '" + scratch().string() + "' && timeout 60 '" LIKENESS_PROGRAM "' " + arguments +
                              " </dev/null >'" + out.string() + "' 2>'" + err.string() + "'";
  const int status = std::system(command.c_str());  // NOLINT(bugprone-command-processor,cert-env33-c): our own words
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(err)};
}

// A refusal is the exit code, nothing on stdout, and one line on stderr that holds each of the words.
void expect_refusal(const std::string& arguments, int exit_code, const std::vector<std::string>& words) {
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.exit_code, exit_code) << "likeness " << arguments << "\n" << outcome.err;
  EXPECT_EQ(outcome.out, "") << "likeness " << arguments;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  for (const std::string& word : words)
    EXPECT_NE(outcome.err.find(word), std::string::npos)
        << "likeness " << arguments << "\nsaid: " << outcome.err << "not: " << word;
}

// The subcommands that a --help lists: the first words of the indented lines after "Subcommands:".
std::vector<std::string> subcommands_in(const std::string& help) {
  std::vector<std::string> names;
  std::istringstream lines(help.substr(std::min(help.find("Subcommands:"), help.size())));
  std::string line, name;
  std::getline(lines, line);
  while (std::getline(lines, line) && line.starts_with("  ")) {
    if (line.size() > 2 && line[2] != ' ' && std::istringstream(line) >> name) names.push_back(name);
  }
  return names;
}

// Every subcommand that can be reached, as the words that lead to it; the program itself is "".
std::vector<std::string> every_subcommand() {
  std::vector<std::string> all, open{""};
  while (!open.empty()) {
    const std::string words = open.back();
    open.pop_back();
    all.push_back(words);
    for (const std::string& name : subcommands_in(run(words + " --help").out)) open.push_back(words + " " + name);
  }
  return all;
}

TEST(CommandLine, ListsTheSubcommandsOfEveryRoom) {
  const auto names = subcommands_in(run("--help").out);
  const std::set<std::string> have(names.begin(), names.end());
  for (const std::string name : {"fit", "convert", "make", "eval", "slice", "cost", "render", "plan"})
    EXPECT_TRUE(have.contains(name)) << name;
}

TEST(CommandLine, HelpsWithEverySubcommand) {
  for (const std::string& words : every_subcommand()) {
    const Outcome outcome = run(words + " --help");
    EXPECT_EQ(outcome.exit_code, 0) << words << outcome.err;
    EXPECT_EQ(outcome.err, "") << words;
    EXPECT_NE(outcome.out.find("Usage: likeness" + words + " "), std::string::npos) << outcome.out;
  }
}

TEST(CommandLine, RefusesAnUnknownOptionOfEverySubcommand) {
  for (const std::string& words : every_subcommand())
    expect_refusal(words + " --no-such-thing", 2, {"likeness" + words + ": unknown option --no-such-thing", "--help"});
}

TEST(CommandLine, SaysItsVersion) {
  const Outcome outcome = run("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out, "likeness " LIKENESS_VERSION "\n");
}

TEST(CommandLine, NamesTheNearestSubcommand) {
  expect_refusal("fitt gold.binary", 2, {"unknown subcommand fitt", "did you mean fit?"});
}
TEST(CommandLine, NamesTheNearestOption) {
  expect_refusal("fit gold.binary --strats 3", 2, {"unknown option --strats", "did you mean --starts?"});
  expect_refusal("fit gold.binary --strats=3", 2, {"did you mean --starts?"});
}
TEST(CommandLine, AsksForASubcommandWhenThereIsNone) {
  expect_refusal("", 2, {"a subcommand is needed", "fit", "convert", "make", "eval", "slice", "cost"});
}
TEST(CommandLine, RefusesANumberThatIsNone) {
  expect_refusal("fit gold.binary --starts many", 2, {"--starts", "many"});
}
TEST(CommandLine, RefusesAModelThatDoesNotExist) {
  expect_refusal("fit gold.binary --model calisto", 2, {"calisto", "callisto"});
}
TEST(CommandLine, SaysWhichSubcommandRefusesAnOption) {
  expect_refusal("fit gold.binary --cut 5", 2, {"likeness fit: --cut 5", "[20, 90]"});
  expect_refusal("convert a.csv a.exr", 2, {"likeness convert: output", ".binary"});
  expect_refusal("make material --invalid 2 --out a.binary", 2, {"likeness make material: --invalid = 2", "[0, 1"});
}

TEST(CommandLine, RefusesAFileThatIsNotThere) {
  expect_refusal("fit no_such.binary", 3, {"no_such.binary"});
  expect_refusal("convert no_such.binary a.csv", 3, {"no_such.binary"});
}

TEST(CommandLine, RefusesAFileThatHoldsSomethingElseAndWritesNothing) {
  const fs::path file = scratch() / "poem.binary", folder = scratch() / "from_a_poem";
  std::ofstream(file) << "Tyger Tyger, burning bright,\nIn the forests of the night;\n";
  expect_refusal("fit poem.binary --out from_a_poem", 3, {"poem.binary"});
  EXPECT_FALSE(fs::exists(folder)) << "a refused input leaves no output";
}

TEST(CommandLine, LeavesNothingOnStdoutWhenItFails) {
  const Outcome outcome = run("fit no_such.binary --json");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.out, "");
}

}  // namespace
}  // namespace likeness::house
