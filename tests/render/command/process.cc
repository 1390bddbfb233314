#include "tests/render/command/process.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "render/files/files.h"

namespace likeness::render_command::test {

namespace fs = std::filesystem;

pid_t Workshop::start(const std::vector<std::string>& words, const std::vector<std::string>& environment) const {
  std::vector<std::string> all{LIKENESS_PROGRAM};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  for (std::string& word : all) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const std::string out = *this / ".out", error = *this / ".error";
  const pid_t child = ::fork();
  if (child != 0) return child;
  if (::chdir(folder_.path().c_str()) != 0) ::_exit(126);
  for (const std::string& variable : environment) ::putenv(const_cast<char*>(variable.c_str()));
  for (const auto& [file, descriptor] : {std::pair{out, 1}, std::pair{error, 2}})
    ::dup2(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), descriptor);
  ::execv(arguments[0], arguments.data());
  ::_exit(127);
}

Ran Workshop::wait_for(pid_t child) const {
  int status = 0;
  ::waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), content(".out"), content(".error")};
}

std::vector<std::string> Workshop::files() const {
  std::vector<std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
    const std::string name = entry.path().lexically_relative(folder_.path()).string();
    if (name != ".out" && name != ".error") out.push_back(name);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::string Workshop::content(const std::string& name) const { return files::read_whole(*this / name, 1 << 28); }

void Workshop::write_ball(const std::string& name, const std::string& from, const std::string& to) const {
  std::string text = R"({
  "format": "likeness scene",
  "version": 1,
  "cameras": [
    {"name": "front", "width": 32, "height": 24, "position": [0, 0, 4], "target": [0, 0, 0], "fov_deg": 40},
    {"name": "side", "width": 24, "height": 32, "position": [4, 0, 0], "target": [0, 0, 0], "fov_deg": 40}
  ],
  "meshes": {"ball": {"shape": "sphere"}},
  "materials": {"plastic": {"parameters": {"base_color": [0.6, 0.1, 0.05], "roughness": 0.4}}},
  "instances": [{"mesh": "ball", "material": "plastic"}],
  "lights": [{"type": "sphere", "name": "lamp", "position": [2, 3, 2], "radius": 0.3, "strength": 20}],
  "environment": {"radiance": [0.1, 0.12, 0.15]}
}
)";
  if (!from.empty()) {
    const std::size_t at = text.find(from);
    if (at == text.npos) ADD_FAILURE() << "the ball has no " << from;
    else text.replace(at, from.size(), to);
  }
  files::write_whole(*this / name, text);
}

double cpu_seconds_of(pid_t child) {
  std::ifstream in("/proc/" + std::to_string(child) + "/stat");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  // Fields 14 and 15, counted from the state, which is the third and follows the name in parentheses.
  std::istringstream fields(text.substr(std::min(text.size(), text.rfind(')') + 1)));
  std::string skipped;
  for (int i = 3; i < 14; ++i) fields >> skipped;
  double user = 0, system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

}  // namespace likeness::render_command::test
