#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "olat/check/rules.h"
#include "render/capture/capture.h"

// Looks for the faults of a capture that make a comparison mean something else than it says.
namespace likeness::olat_check {

struct Finding {
  Rule rule = Rule::kMissingFrame;
  std::string camera, light;  // ids; empty: all of them
  std::string file;
  double value = 0;  // in the unit of the rule, above what the rule allows
  std::string text;  // one line: what was found
};

// What a rule measured of a camera, also where it is allowed.
struct Measured {
  Rule rule = Rule::kMissingFrame;
  std::string camera;
  double value = 0;
  std::string text;
};

struct NotChecked {
  Rule rule = Rule::kMissingFrame;
  std::string camera;  // empty: all of them
  std::string reason;
};

struct Report {
  std::vector<Finding> findings;  // in the order of the rules, then of cameras and lights
  std::vector<Measured> measured;
  std::vector<NotChecked> not_checked;
  std::size_t photos = 0, renders = 0;  // that were read
  std::string variant;                  // of the renders; empty: none
  bool is_complete = true;              // false: interrupted
};

struct Options {
  std::string variant;       // id; empty: the first that has renders
  bool reads_hashes = true;  // false: sha256 and exposure_attributes are left out
  std::function<bool(std::string_view what, double share)> keep_going;  // false: stop
};

// Photos are read one after another by each thread of TBB and let go, so memory is two pictures a thread and a few
// numbers a pair. The report does not depend on the number of threads. Throws files::UsageError for a variant that the
// capture does not have; files that cannot be used are findings.
Report run_check(const capture::Capture& capture, const Options& options = {});

// For people, a line a finding and its way out; and for programs (docs/olat_check.md says what is in it).
std::string text_of(const Report& report, const capture::Capture& capture);
std::string json_of(const Report& report, const capture::Capture& capture);

// kRules as a table in Markdown, for docs/olat_check.md.
std::string rules_table();

}  // namespace likeness::olat_check
