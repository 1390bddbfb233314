#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace likeness::files {

// One line on standard error that says how far long work has come; nothing where that is no terminal, and nothing
// during the first second.
class Progress {
 public:
  Progress();
  ~Progress();  // takes the line away
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // `share` of the work is done, 0 if that is not known.
  void tell(std::string_view what, double share);

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point began_, told_;
  bool terminal_, shown_ = false;
};

// "12 s", "3 min 4 s", "2 h 0 min 1 s"
std::string duration_text(double seconds);

}  // namespace likeness::files
