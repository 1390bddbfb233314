#include "tests/house/layout.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace likeness::house {
namespace {

namespace fs = std::filesystem;

// The files that git knows or would add, or, in a tree without git, all but what a build leaves.
Tree this_repository() {
  const fs::path root = LIKENESS_SOURCE_DIR;
  Tree tree;
  const auto add = [&](const std::string& path) {
    std::ifstream in(root / path, std::ios::binary);
    std::string content{std::istreambuf_iterator<char>(in), {}};
    if (in) tree[path] = content.find('\0') == std::string::npos ? std::move(content) : std::string();
  };
  const std::string list =
      "git -C '" + root.string() + "' ls-files -z --cached --others --exclude-standard 2>/dev/null";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(list.c_str(), "r"), pclose);
  std::string paths;
  std::array<char, 4096> block;
  while (const std::size_t count = pipe ? std::fread(block.data(), 1, block.size(), pipe.get()) : 0)
    paths.append(block.data(), count);
  for (std::size_t at = 0, end; (end = paths.find('\0', at)) != std::string::npos; at = end + 1)
    add(paths.substr(at, end - at));
  if (!tree.empty()) return tree;
  for (auto at = fs::recursive_directory_iterator(root); at != fs::recursive_directory_iterator(); ++at) {
    const std::string path = at->path().lexically_relative(root).generic_string();
    if (path == "build" || path == "out" || path == ".git") at.disable_recursion_pending();
    else if (at->is_regular_file()) add(path);
  }
  return tree;
}

const Tree& repository() {
  static const Tree tree = this_repository();
  return tree;
}

std::string joined(const std::vector<std::string>& faults) {
  std::string text;
  for (const std::string& fault : faults) text += "  " + fault + "\n";
  return text;
}

// Three rooms one above the other, as the repository declares them.
Tree small_house() {
  return {
      {"brdf/CMakeLists.txt",
       "# likeness_library(nothing NEEDS likeness::fit)\nlikeness_library(brdf WITH glm::glm)\n"},
      {"brdf/ggx.h", "#pragma once\n"},
      {"fit/CMakeLists.txt", "likeness_library(fit SOURCES fit.cc\n  NEEDS likeness::measured WITH Ceres::ceres)\n"},
      {"fit/fit.cc", "#include <vector>\n#include \"fit/measured/merl.h\"\n#include \"brdf/ggx.h\"\n"},
      {"fit/measured/CMakeLists.txt", "likeness_library(measured SOURCES merl.cc NEEDS likeness::brdf)\n"},
      {"fit/measured/merl.h", "#pragma once\n#include \"brdf/ggx.h\"\n"},
      {"main.cc", "#include \"fit/measured/merl.h\"\n"},
      {"tests/fit/fit_test.cc", "#include \"fit/fit.h\"\n"},
  };
}
Tree with(const std::string& path, const std::string& content) {
  Tree tree = small_house();
  tree[path] = content;
  return tree;
}

TEST(ThisRepository, IncludesOnlyDownwards) {
  ASSERT_TRUE(rooms_of(repository()).contains("brdf")) << "the rooms' CMakeLists.txt were not read";
  EXPECT_EQ(joined(upward_includes(repository())), "");
}
TEST(ThisRepository, HasEveryFileInARoomUnderANameThatSaysWhatItIs) {
  EXPECT_EQ(joined(misplaced_files(repository())), "");
}
TEST(ThisRepository, HasNoSourceFileOver600Lines) {
  std::cout << "Over 400 lines, soon to be split:\n" << joined(oversized_files(repository(), 400));
  EXPECT_EQ(joined(oversized_files(repository(), 600)), "");
}
TEST(ThisRepository, HasNoDeadOrPostponedCode) { EXPECT_EQ(joined(dead_or_postponed_code(repository())), ""); }
TEST(ThisRepository, NamesNoPathOfOneMachine) { EXPECT_EQ(joined(machine_paths(repository())), ""); }
TEST(ThisRepository, GuardsItsHeaders) { EXPECT_EQ(joined(unguarded_headers(repository())), ""); }

TEST(ThisRepository, NeedsOnlyGlmForItsEvaluators) { EXPECT_EQ(joined(foreign_includes_of_brdf(repository())), ""); }
TEST(ThisRepository, LinksOnlyToPagesThatAreThere) { EXPECT_EQ(joined(broken_links(repository())), ""); }

// Each rule finds the fault that it is for, and nothing in a house without faults.

TEST(LayoutRules, FindNothingInASoundHouse) {
  const Tree tree = small_house();
  EXPECT_EQ(joined(upward_includes(tree)) + joined(misplaced_files(tree)) + joined(oversized_files(tree, 600)) +
                joined(dead_or_postponed_code(tree)) + joined(machine_paths(tree)) + joined(unguarded_headers(tree)),
            "");
}

TEST(LayoutRules, ReadRoomsAndTheirNeedsButNotComments) {
  const auto rooms = rooms_of(small_house());
  ASSERT_EQ(rooms.size(), 3u);
  EXPECT_EQ(rooms.at("fit").needs, std::vector<std::string>{"measured"});
  EXPECT_EQ(rooms.at("measured").folder, "fit/measured");
  EXPECT_TRUE(rooms.at("brdf").needs.empty());
}

TEST(LayoutRules, FindAnUpwardInclude) {
  const auto faults = upward_includes(with("brdf/ggx.h", "#pragma once\n#include \"fit/measured/merl.h\"\n"));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].substr(0, 60), "brdf/ggx.h:2: room brdf includes \"fit/measured/merl.h\" of ro");
  EXPECT_EQ(upward_includes(with("fit/measured/merl.h", "#  include \"fit/fit.h\"\n")).size(), 1u);
}

TEST(LayoutRules, FindAnIncludeOfATestAndAFileInNoRoom) {
  EXPECT_EQ(upward_includes(with("fit/fit.cc", "#include \"tests/fit/planted.h\"\n")).size(), 1u);
  EXPECT_EQ(upward_includes(with("render/stray.cc", "")).size(), 1u);
}

TEST(LayoutRules, FindRoomsThatNeedEachOtherOrARoomThatIsNone) {
  EXPECT_EQ(upward_includes(with("brdf/CMakeLists.txt", "likeness_library(brdf NEEDS likeness::fit)")).size(), 3u)
      << "each of the three rooms of the ring";
  EXPECT_EQ(upward_includes(with("brdf/CMakeLists.txt", "likeness_library(brdf NEEDS likeness::atoms)")).size(), 1u);
}

TEST(LayoutRules, FindNamesThatSayNothing) {
  for (const std::string path : {"brdf/utils.h", "brdf/math_utils.h", "fit/common/a.h", "fit/helpers.cc", "fit/types.h",
                                 "render/core/a.cc", "fit/solver_manager.h", "brdf/base.h"})
    EXPECT_EQ(misplaced_files(with(path, "#pragma once\n")).size(), 1u) << path;
  for (const std::string path : {"fit/database.cc", "docs/base_color.md", "tests/commonplace.cc"})
    EXPECT_EQ(joined(misplaced_files(with(path, ""))), "") << path;
}

TEST(LayoutRules, FindUnknownFoldersAndRootFiles) {
  EXPECT_EQ(misplaced_files(with("src/a.cc", "")).size(), 1u);
  EXPECT_EQ(misplaced_files(with("notes.txt", "")).size(), 1u);
}

TEST(LayoutRules, FindOversizedSourcesButNotOversizedTables) {
  EXPECT_EQ(oversized_files(with("fit/fit.cc", std::string(601, '\n')), 600).size(), 1u);
  EXPECT_EQ(oversized_files(with("fit/fit.cc", std::string(600, '\n')), 600).size(), 0u);
  EXPECT_EQ(oversized_files(with("tests/fit/reference.csv", std::string(9000, '\n')), 600).size(), 0u);
}

TEST(LayoutRules, FindDeadAndPostponedCode) {
  // A letter of each is spelled in octal, so that this file does not report itself.
  for (const std::string line :
       {"#if \060", "TEST(A, DISABLED\137B) {", "// TOD\117: later", "x();  // FIXM\105", "GTEST_SKIP\050);"})
    EXPECT_EQ(dead_or_postponed_code(with("tests/fit/fit_test.cc", "\n" + line + "\n")).size(), 1u) << line;
  for (const std::string line : {"GTEST_SKIP() << \"no shared data\";", "#if 01", "// the TODOS of others"})
    EXPECT_EQ(joined(dead_or_postponed_code(with("tests/fit/fit_test.cc", line))), "") << line;
}

TEST(LayoutRules, FindPathsOfOneMachine) {
  for (const std::string line : {"read(\"/r\157ot/a.binary\")", "see /w\157rk/main", "/h\157me/me/x"})
    EXPECT_EQ(machine_paths(with("docs/fit.md", line)).size(), 1u) << line;
  EXPECT_EQ(joined(machine_paths(with("docs/fit.md", "out/work/a, ../shared/data"))), "");
}

TEST(LayoutRules, FindAHeaderWithoutPragmaOnce) {
  EXPECT_EQ(unguarded_headers(with("fit/a.h", "int a;\n")).size(), 1u);
}

TEST(LayoutRules, FindAPackageThatBrdfMustNotNeed) {
  EXPECT_EQ(foreign_includes_of_brdf(with("brdf/ggx.h", "#include <Eigen/Core>\n")).size(), 1u);
  EXPECT_EQ(foreign_includes_of_brdf(with("brdf/ggx.h", "#include <cmath>\n#include <glm/vec3.hpp>\n")).size(), 0u);
  EXPECT_EQ(foreign_includes_of_brdf(with("brdf/jet.h", "#include <ceres/jet.h>\n")).size(), 0u);
}

TEST(LayoutRules, FindABrokenLinkOfAPage) {
  const std::string good = "[a](../brdf/ggx.h), [b](../fit), [c](../fit/), [d](https://example.org/x), [e](#here)";
  EXPECT_EQ(joined(broken_links(with("docs/fit.md", good))), "");
  EXPECT_EQ(broken_links(with("docs/fit.md", "[a](ggx.h)")).size(), 1u);
  EXPECT_EQ(broken_links(with("README.md", "![picture](docs/none.png)")).size(), 1u);
}

}  // namespace
}  // namespace likeness::house
