#include "olat/compare/command.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "olat/compare/compare.h"
#include "render/capture/files_of_capture.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"

namespace likeness::olat_compare {
namespace {

struct CommandLine {
  std::string capture, match, weight = "mask", out;
  std::vector<std::string> metrics, fail, warn;
  Options options;
  bool csv = false, json = false;
};

template <std::size_t N>
std::size_t choice(const std::array<Choice, N>& rows, const std::string& id, const char* option) {
  std::array<std::string_view, N> names{};
  for (std::size_t k = 0; k < N; ++k) {
    names[k] = rows[k].word;
    if (id == names[k]) return k;
  }
  const std::string near = files::nearest_name(id, names.data(), N);
  std::string all;
  for (const auto name : names) all += (all.empty() ? "" : ", ") + std::string(name);
  throw files::UsageError(std::string(option) + " " + files::in_quotes(id) + " is unknown" +
                          (near.empty() ? "" : "; did you mean " + near + "?") + "; there are " + all);
}

int run(CommandLine line) {
  if (line.csv && line.json) throw files::UsageError("--csv and --json exclude each other; give one of them");
  std::vector<Limit> fail, warn;
  for (const std::string& text : line.fail) fail.push_back(limit_of(text));
  for (const std::string& text : line.warn) warn.push_back(limit_of(text));
  for (const std::string& id : line.metrics) line.options.metrics.push_back(metric::metric_of(id));
  for (const auto* limits : {&fail, &warn})
    for (const Limit& limit : *limits)
      if (!line.options.metrics.empty() && std::ranges::count(line.options.metrics, limit.metric) == 0)
        throw files::UsageError("a limit is set on " + std::string(metric::row_of(limit.metric).id) +
                                ", which --metric leaves out");
  line.options.weight = static_cast<Weight>(choice(kWeights, line.weight, "--weight"));
  capture::Capture capture;
  try {
    capture = capture::read_capture(line.capture);
  } catch (const files::InputError& error) {
    std::cerr << error.what() << "\n";
    return kFileError;
  }
  line.options.match = static_cast<Match>(
      choice(kMatches, line.match.empty() ? capture.pipeline.match_gain : line.match, "--match-gain"));
  if (!line.out.empty()) {
    std::filesystem::create_directories(line.out);
    line.options.cache = (std::filesystem::path(line.out) / "compare.cache").string();
  }
  files::catch_interrupts();
  Comparison comparison;
  {
    files::Progress progress;
    line.options.keep_going = [&](std::string_view what, double share) {
      progress.tell(what, share);
      return !files::interrupted();
    };
    comparison = run_compare(capture, line.options);
  }
  const int code = exit_code_of(comparison, fail, warn);
  std::cout << (line.csv    ? csv_of(comparison, capture)
                : line.json ? json_of(comparison, capture)
                            : table_of(comparison, capture));
  if (!line.out.empty()) {
    const std::filesystem::path folder = line.out;
    files::write_whole(folder / "compare.csv", csv_of(comparison, capture));
    files::write_whole(folder / "compare.json", json_of(comparison, capture));
    std::cerr << "written: " << (folder / "compare.csv").string() << " and compare.json";
    if (comparison.from_cache > 0) std::cerr << "; " << comparison.from_cache << " results were there from before";
    std::cerr << "\n";
  }
  if (comparison.is_complete) return code;
  std::cerr << "likeness olat compare: interrupted"
            << (line.out.empty() ? "; with --out the next run would go on from here" : "; run it again to go on")
            << "\n";
  return 130;
}

std::string footer() {
  const auto padded = [](std::string_view id) {
    std::string text(id);
    text.resize(12, ' ');
    return "  " + text;
  };
  std::string text = "Metrics\n";
  for (const metric::MetricRow& row : metric::kMetrics)
    text += padded(row.id) + std::string(row.text) + " [" + std::string(row.unit) + "]\n";
  text += "Statistics, over the pixels inside the mask that are not clipped\n";
  for (const metric::StatisticRow& row : metric::kStatistics) text += padded(row.id) + std::string(row.text) + "\n";
  text += "Match gain: what a render is multiplied by\n";
  for (const Choice& row : kMatches) text += padded(row.word) + std::string(row.text) + "\n";
  return text + R"(
Examples
  likeness olat compare capture                                  totals and the worst pairs
  likeness olat compare capture --out out/compare                and compare.csv, compare.json; run again to resume
  likeness olat compare capture --metric stops --metric flip --csv
  likeness olat compare capture --match-gain light               how far, but for the intensity of each light
  likeness olat compare capture --fail stops.p95=1 --warn 0.5    a test: exit codes as those of idiff

Exit codes: 0 within the limits, 1 a warning limit is passed, 2 a failing one (or usage), 3 a size differs,
4 a file cannot be used or no pair has both pictures, 130 interrupted.
Manual: docs/olat_compare.md)";
}

}  // namespace

void add_compare(CLI::App& olat, int& exit_code) {
  const auto line = std::make_shared<CommandLine>();
  CLI::App* app = olat.add_subcommand("compare", "How far are photos and renders apart: every metric of every pair");
  app->add_option("CAPTURE", line->capture, "Folder with capture.json, or that file")->required();
  app->add_option("--variant", line->options.variant, "Renders to compare; without it, the first that has renders");
  app->add_option("--metric", line->metrics, "A metric, as often as wanted; without it, all");
  app->add_option("--match-gain", line->match, "none, capture, light or channel; without it, as capture.json says");
  app->add_option("--weight", line->weight, "mask, or cosine: pixels by N.L")->capture_default_str();
  app->add_option("--camera", line->options.cameras, "Only this camera; as often as wanted");
  app->add_option("--light", line->options.lights, "Only this light; as often as wanted");
  app->add_option("--view", line->options.view, "View of delta_e and flip; without it, the capture's");
  app->add_option("--ev", line->options.ev, "Exposure of the view, on top of the capture's [stops]")
      ->check(CLI::Range(-100.0, 100.0));
  app->add_option("--fail", line->fail,
                  "Exit code 2 if a pair has more: NUMBER of stops.p95, or METRIC.STATISTIC=NUMBER");
  app->add_option("--warn", line->warn, "Exit code 1 if a pair has more");
  app->add_option("--out", line->out, "Folder for compare.csv, compare.json and what the next run goes on from");
  app->add_flag("--csv", line->csv, "Print a row for each pair and metric");
  app->add_flag("--json", line->json, "Print everything as JSON");
  app->footer(footer());
  app->callback([line, &exit_code] { exit_code = run(*line); });
}

}  // namespace likeness::olat_compare
