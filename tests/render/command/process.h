#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/render/temporary_folder.h"

// `likeness` as a user runs it: the built program in a folder of its own.
namespace likeness::render_command::test {

struct Ran {
  int exit_code = -1;  // minus the signal, if one ended it
  std::string out, error;
};

class Workshop {
 public:
  // Starts `likeness WORDS` in the folder; `environment` is NAME=VALUE.
  pid_t start(const std::vector<std::string>& words, const std::vector<std::string>& environment = {}) const;
  // Its end.
  Ran wait_for(pid_t child) const;
  Ran run(const std::vector<std::string>& words, const std::vector<std::string>& environment = {}) const {
    return wait_for(start(words, environment));
  }

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  // Its files without the streams of what ran, sorted.
  std::vector<std::string> files() const;
  std::string content(const std::string& name) const;

  // A ball of red plastic under a lamp, two cameras of 32 x 24 and 24 x 32 pixels. `from` is replaced by `to`.
  void write_ball(const std::string& name = "ball.json", const std::string& from = "",
                  const std::string& to = "") const;

 private:
  likeness::test::TemporaryFolder folder_;
};

// CPU seconds that a running process has used.
double cpu_seconds_of(pid_t child);

}  // namespace likeness::render_command::test
