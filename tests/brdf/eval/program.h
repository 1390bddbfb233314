#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/files/files.h"

// The built program, run in a folder of its own.
namespace likeness::eval::test {

namespace fs = std::filesystem;

struct Ran {
  int exit_code = -1;  // minus the signal, if one ended it
  std::string out, error;
  long most_memory_kb = 0;
};

class Program : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }

  // Arguments as a shell splits them; LIKENESS stands for the program.
  Ran shell(const std::string& command) const {
    const pid_t child = start(command);
    Ran ran;
    int status = 0;
    rusage used{};
    ::wait4(child, &status, 0, &used);
    ran.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    ran.most_memory_kb = used.ru_maxrss;
    ran.out = read(".out");
    ran.error = read(".error");
    return ran;
  }
  Ran run(const std::string& arguments) const { return shell("exec likeness eval " + arguments); }

  pid_t start(const std::string& command) const {
    const pid_t child = ::fork();
    if (child != 0) return child;
    if (::chdir(folder.c_str()) != 0) ::_exit(126);
    const std::string path = fs::path(LIKENESS_PROGRAM).parent_path().string() + ":" + std::getenv("PATH");
    ::setenv("PATH", path.c_str(), 1);
    ::dup2(::open("/dev/null", O_RDONLY), 0);
    ::dup2(::open(".out", O_WRONLY | O_CREAT | O_TRUNC, 0644), 1);
    ::dup2(::open(".error", O_WRONLY | O_CREAT | O_TRUNC, 0644), 2);
    ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    ::_exit(127);
  }

  void write(const std::string& name, std::string_view content) const { files::write_whole(folder / name, content); }
  std::string read(const std::string& name) const { return files::read_whole(folder / name, 500'000'000); }

  // A refusal is an exit code, one line on standard error that holds the words, and no file.
  void expect_refusal(const std::string& arguments, int exit_code, const std::vector<std::string>& words) const {
    const Ran ran = run(arguments + " --out refused.csv");
    EXPECT_EQ(ran.exit_code, exit_code) << arguments << "\n" << ran.error;
    const auto lines = std::count(ran.error.begin(), ran.error.end(), '\n');
    const auto notes = ran.error.starts_with("likeness eval: defaults: ") ? 1 : 0;  // said before the rows are read
    EXPECT_EQ(lines, 1 + notes) << ran.error;
    for (const std::string& word : words)
      EXPECT_NE(ran.error.find(word), std::string::npos) << arguments << "\nsaid: " << ran.error << "not: " << word;
    EXPECT_FALSE(fs::exists(folder / "refused.csv")) << arguments;
  }

  const fs::path folder = fs::path(testing::TempDir()) / ("likeness_eval_" + std::to_string(::getpid()));
};

}  // namespace likeness::eval::test
