#include "olat/check/command.h"

#include <iostream>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "olat/check/check.h"
#include "render/capture/files_of_capture.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"

namespace likeness::olat_check {
namespace {

struct CommandLine {
  std::string capture, variant;
  bool json = false, no_hash = false;
};

int run(const CommandLine& line) {
  const capture::Capture capture = capture::read_capture(line.capture);
  files::catch_interrupts();
  files::Progress progress;
  Options options{line.variant, !line.no_hash, {}};
  options.keep_going = [&](std::string_view what, double share) {
    progress.tell(what, share);
    return !files::interrupted();
  };
  const Report report = run_check(capture, options);
  std::cout << (line.json ? json_of(report, capture) : text_of(report, capture));
  return !report.is_complete ? 130 : report.findings.empty() ? 0 : 1;
}

std::string footer() {
  std::string text = "What it looks for\n";
  for (const RuleRow& row : kRules) {
    std::string id(row.id);
    id.resize(22, ' ');
    text += "  " + id + std::string(row.text) + "\n";
  }
  return text + R"(
Examples
  likeness olat check capture                  every finding with its camera, light, value and way out
  likeness olat check capture --json           the same for a program
  likeness olat check capture --no-hash        faster: does not read files a second time for their SHA-256

Exit codes: 0 clean, 1 something was found, 2 usage, 3 the capture cannot be read, 130 interrupted.
Manual: docs/olat_check.md)";
}

}  // namespace

void add_check(CLI::App& olat, int& exit_code) {
  const auto line = std::make_shared<CommandLine>();
  CLI::App* app = olat.add_subcommand("check", "Looks for faults of a capture: lights, files, black, clipping, shifts");
  app->add_option("CAPTURE", line->capture, "Folder with capture.json, or that file")->required();
  app->add_option("--variant", line->variant, "Renders to look at; without it, the first that has renders");
  app->add_flag("--json", line->json, "Print the report as JSON");
  app->add_flag("--no-hash", line->no_hash, "Do not compare SHA-256 and the attributes of EXRs");
  app->footer(footer());
  app->callback([line, &exit_code] { exit_code = run(*line); });
}

}  // namespace likeness::olat_check
