#pragma once

#include <string>

#include "olat/check/check.h"

namespace likeness::olat_check {

// A report in the making: a value becomes a finding if it is above what its rule allows.
class Finder {
 public:
  Finder(const capture::Capture& capture, Report& report) : capture_(capture), report_(report) {}

  // Positions in the lists of the capture; capture::kAbsent: all of them.
  struct Place {
    std::size_t camera = capture::kAbsent, light = capture::kAbsent;
    std::string file{};
  };
  void judge(Rule rule, const Place& place, double value, const std::string& text) const {
    if (value > row_of(rule).allowed) report(rule, place, value, text);
  }
  // The same, and told whether it is allowed or not.
  void measured(Rule rule, const Place& place, double value, const std::string& text) const {
    report_.measured.push_back({rule, capture_.cameras[place.camera].id, value, text});
    judge(rule, place, value, text);
  }
  void report(Rule rule, const Place& place, double value, const std::string& text) const {
    report_.findings.push_back({rule, place.camera == capture::kAbsent ? "" : capture_.cameras[place.camera].id,
                                place.light == capture::kAbsent ? "" : capture_.lights[place.light].id, place.file,
                                value, text});
  }
  void leave_out(Rule rule, std::size_t camera, const std::string& reason) const {
    report_.not_checked.push_back({rule, camera == capture::kAbsent ? "" : capture_.cameras[camera].id, reason});
  }

 private:
  const capture::Capture& capture_;
  Report& report_;
};

// The rules that need no picture, in lists.cc.
void check_lists(const capture::Capture& capture, const Finder& finder);

// "001, 002, 003 and 12 more"
std::string some_of(const std::vector<std::string>& ids);
std::string number(double value);  // three significant digits

}  // namespace likeness::olat_check
