#include <csignal>
#include <thread>

#include <gmock/gmock.h>

#include "brdf/cost/ladder.h"
#include "tests/brdf/eval/program.h"

// `likeness cost evaluators` as a user runs it.
namespace likeness::cost {
namespace {

using eval::test::Program;
using eval::test::Ran;
using testing::HasSubstr;
namespace fs = std::filesystem;

class CostCommand : public Program {
 protected:
  Ran cost(const std::string& arguments) const { return shell("exec likeness cost evaluators " + arguments); }
};

TEST_F(CostCommand, PrintsATableAndWritesThePageAndTheCsv) {
  const Ran ran = cost("--family fresnel --family tonemap --repeats 1 --seconds 2e-4 --draws 0.01 --out a/b");
  EXPECT_EQ(ran.exit_code, 0) << ran.error;
  EXPECT_THAT(ran.out, HasSubstr("Fresnel reflectance of metals (fresnel)"));
  EXPECT_THAT(ran.out, HasSubstr("GT tonemapper (tonemap)"));
  EXPECT_EQ(ran.error, "written: a/b/evaluators.html and evaluators.csv beside it\n");
  EXPECT_THAT(read("a/b/evaluators.html"), HasSubstr("</html>"));
  EXPECT_THAT(read("a/b/evaluators.csv"), HasSubstr("family,form,evaluator,precision,loop,ns,"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "a/b"), fs::directory_iterator()), 2);
}

TEST_F(CostCommand, PrintsCsv) {
  const Ran ran = cost("--family tonemap --repeats 1 --seconds 2e-4 --draws 0.01 --csv");
  EXPECT_EQ(ran.exit_code, 0) << ran.error;
  EXPECT_TRUE(ran.out.starts_with("family,form,")) << ran.out;
  EXPECT_EQ(std::count(ran.out.begin(), ran.out.end(), '\n'), 1 + 2 * 3);
}

TEST_F(CostCommand, RefusesAnUnknownFamilyAndNamesTheKnown) {
  const Ran ran = cost("--family fur --out refused");
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(std::count(ran.error.begin(), ran.error.end(), '\n'), 1) << ran.error;
  EXPECT_THAT(ran.error, HasSubstr("there is no family 'fur'"));
  for (const Family& family : families()) EXPECT_THAT(ran.error, HasSubstr(family.name));
  EXPECT_FALSE(fs::exists(folder / "refused"));
}

TEST_F(CostCommand, HelpNamesEveryFamily) {
  const Ran ran = cost("--help");
  for (const Family& family : families()) EXPECT_THAT(ran.out, HasSubstr(family.name));
}

TEST_F(CostCommand, SaysAtOnceThatAFolderCannotBeWritten) {
  write("taken", "a file");
  const auto began = std::chrono::steady_clock::now();
  const Ran ran = cost("--repeats 1000 --out taken");
  EXPECT_EQ(ran.exit_code, 4) << ran.error;
  EXPECT_THAT(ran.error, HasSubstr("taken"));
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(20)) << "before it measures";
}

TEST_F(CostCommand, AnInterruptedRunLeavesNothing) {
  for (const int signal : {SIGINT, SIGTERM}) {
    write("out/evaluators.csv", "precious\n");
    const pid_t child = start("exec likeness cost evaluators --family fresnel --repeats 10000 --out out");
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status)) << signal;
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_THAT(read(".error"), HasSubstr("interrupted; nothing is written"));
    EXPECT_EQ(read(".out"), "");
    EXPECT_EQ(read("out/evaluators.csv"), "precious\n");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out"), fs::directory_iterator()), 1);
  }
}

}  // namespace
}  // namespace likeness::cost
