#include "realis/report/command.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "realis/command.h"
#include "realis/export/export.h"
#include "realis/report/leave_one_out.h"
#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"

namespace likeness::realis {
namespace {

struct ReportRequest {
  std::string capture, camera, variant, out;
  std::size_t texels = StudyOptions{}.texels;
  bool no_rgb = false, no_bake = false, is_json = false;
  double floor = BakeOptions{}.floor;
};

// Bakes as `likeness realis bake` does, where no bake is there.
void bake_if_absent(const capture::Capture& capture, const ReportRequest& request) {
  if (std::filesystem::exists(capture.root / "realis" / "bake" / "bake.json")) return;
  CLI::App program;
  int exit_code = 0;
  add_realis(program, exit_code);
  std::vector<std::string> words{"realis", "bake", request.capture, "--floor", files::number_text(request.floor)};
  if (!request.camera.empty()) words.insert(words.end(), {"--camera", request.camera});
  std::ranges::reverse(words);  // as CLI11 takes them
  std::ostringstream said;      // the report has a table of its own
  std::streambuf* const out = std::cout.rdbuf(said.rdbuf());
  try {
    program.parse(words);
  } catch (...) {
    std::cout.rdbuf(out);
    throw;
  }
  std::cout.rdbuf(out);
  if (exit_code != 0) throw files::Interrupted();
}

int run_report(const ReportRequest& request) {
  files::catch_interrupts();
  const capture::Capture capture = capture::read_capture(request.capture);
  StudyOptions options;
  options.texels = request.texels, options.with_rgb = !request.no_rgb, options.floor = request.floor;
  if (!(options.floor > 0 && options.floor <= 1))
    throw files::UsageError("--floor = " + files::number_text(options.floor) + " is outside (0, 1]");
  std::size_t camera = 0;
  if (!request.camera.empty() && (camera = capture::camera_of(capture, request.camera)) == capture::kAbsent)
    throw files::UsageError("--camera " + files::in_quotes(request.camera) + " is not in the capture");
  if (!request.variant.empty()) {
    options.variant = capture::variant_of(capture, request.variant);
    if (*options.variant == capture::kAbsent)
      throw files::UsageError("--variant " + files::in_quotes(request.variant) + " is not in the capture");
  }
  Study study;
  {
    files::Progress progress;
    study = leave_one_out(capture, camera, options, [&](double share, std::string_view what) {
      progress.tell(what, share);
      return !files::interrupted();
    });
  }
  const std::filesystem::path folder =
      request.out.empty() ? capture.root / "realis" / "report" : std::filesystem::path(request.out);
  std::filesystem::create_directories(folder);
  files::write_whole(folder / "report.html", page_of(study, ""));
  files::write_whole(folder / "report.csv", csv_of(study));
  files::write_whole(folder / "report.json", json_of(study));
  // Renders of a variant are not the fit that is baked here: there `likeness realis bake --variant` comes first.
  const bool has_page = !request.no_bake && request.variant.empty() && study.is_complete;
  if (has_page) {
    bake_if_absent(capture, request);
    files::Progress progress;
    const std::string page = relight_page(capture, "bake", [&](double share, std::string_view what) {
      progress.tell(what, share);
      return !files::interrupted();
    });
    files::write_whole(folder / "relight.html", page);
    files::write_whole(folder / "report.html", page_of(study, "relight.html"));
  }
  if (request.is_json) std::cout << json_of(study);
  else std::cout << table_of(study) << "page, CSV and JSON: " << (folder / "report.html").string() << "\n";
  if (!request.is_json && has_page)
    std::cout << "the subject, with a light to move: " << (folder / "relight.html").string() << "\n";
  return 0;
}

}  // namespace

void add_report(CLI::App& realis, int& exit_code) {
  CLI::App* report = realis.add_subcommand("report", "Leave every light out once; compare with other ways to relight");
  auto request = std::make_shared<ReportRequest>();
  report->add_option("CAPTURE", request->capture, "folder with capture.json (likeness olat import)")->required();
  report->add_option("--camera", request->camera, "whose photographs; default: the first");
  report->add_option("--variant", request->variant,
                     "renders that are there, instead of those of fits of the other photographs");
  report->add_option("--texels", request->texels, "at most, on an even grid of the picture; 0: as many as are taken")
      ->check(CLI::Range(std::size_t{0}, kMostTexels))
      ->capture_default_str();
  report->add_flag("--no-rgb", request->no_rgb, "leave the residuals of each color out: half of the time");
  report->add_option("--floor", request->floor, "least cosine that a residual is divided by")->capture_default_str();
  report->add_flag("--no-bake", request->no_bake, "the study alone: nothing is baked, and there is no page to relight");
  report->add_option("--out", request->out, "folder; default: CAPTURE/realis/report");
  report->add_flag("--json", request->is_json, "the numbers as JSON instead of the table");
  report->footer(
      R"(Each light is foretold from photographs under all others; nothing that is used has seen it. Ctrl-C keeps the rows
that are finished. Where CAPTURE/realis/bake is not there it is baked, and relight.html shows it under a light that the
reader moves.

Examples
  likeness realis report capture                     table, pages, CSV and JSON: CAPTURE/realis/report
  likeness realis report capture --texels 500        a quick look
  likeness realis report head --variant path_traced  over renders of a scene, as they are

Exit codes: 0 done, 2 usage, 3 a file cannot be used, 4 the program failed.)");
  report->callback([request, &exit_code] { exit_code = run_report(*request); });
}

}  // namespace likeness::realis
