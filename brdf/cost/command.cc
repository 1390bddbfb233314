#include "brdf/cost/command.h"

#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "brdf/cost/study.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"

namespace likeness::cost {
namespace {

struct Request {
  Options options;
  std::string out;
  bool csv = false, markdown = false;
};

int run(const Request& request) {
  const bool on_terminal = isatty(STDERR_FILENO) == 1;
  const std::filesystem::path folder = request.out;
  // Before anything is measured: what there is not, and a folder that cannot be written to, are said at once.
  try {
    chosen_families(request.options.families);
  } catch (const std::invalid_argument& error) {
    throw files::UsageError(error.what());
  }
  std::optional<files::WholeFile> csv, page;
  if (!request.out.empty()) csv.emplace(folder / "evaluators.csv"), page.emplace(folder / "evaluators.html");
  files::catch_interrupts();
  Study study;
  try {
    study = run_study(request.options, [&](const std::string& what, double share) {
      if (files::interrupted()) throw files::Interrupted{};
      if (on_terminal) std::fprintf(stderr, "\r\033[K%3.0f %%  %s", 100 * share, what.c_str());
    });
  } catch (const files::Interrupted&) {
    std::cerr << (on_terminal ? "\n" : "") << "likeness cost: interrupted; nothing is written\n";
    return 130;
  }
  if (on_terminal) std::fprintf(stderr, "\r\033[K");
  std::cout << (request.csv ? csv_of(study) : request.markdown ? markdown_of(study) : table_of(study));
  if (csv) {
    csv->append(csv_of(study)), csv->commit();
    page->append(page_of(study)), page->commit();
    std::cerr << "written: " << (folder / "evaluators.html").string() << " and evaluators.csv beside it\n";
  }
  return 0;
}

}  // namespace

CLI::App& add_cost(CLI::App& program, int& exit_code) {
  CLI::App* cost = program.add_subcommand("cost", "Measure what accuracy costs in time, on this machine");
  cost->require_subcommand(1);
  auto request = std::make_shared<Request>();
  CLI::App* evaluators = cost->add_subcommand(
      "evaluators", "Time and error of every form of the run-time evaluators, from the cheapest to the reference");
  evaluators->footer(
      "Measures, in one process and interleaved, nanoseconds and instructions for each evaluation in double, float "
      "and\n"
      "batches, against the error of each form, and prints one table for each family.\n"
      "\n"
      "  likeness cost evaluators --out out/cost             all families, a minute or two; and a page with plots\n"
      "  likeness cost evaluators --family hair --repeats 51 one family, more readings\n"
      "\n"
      "Exit codes: 0 done, 2 usage, 4 the results cannot be written, 130 interrupted.");
  evaluators->add_option(
      "--family", request->options.families,
      "Only these: diffuse, fresnel, hair, diffusion_inverse, diffusion_profile, normal_length, tonemap, realis");
  evaluators->add_option("--repeats", request->options.repeats, "Readings of each form; the median of them counts")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  evaluators->add_option("--seconds", request->options.seconds, "CPU time of one reading")
      ->check(CLI::Range(1e-4, 10.0))
      ->capture_default_str();
  evaluators
      ->add_option("--draws", request->options.draws_scale, "Times the number of inputs that errors are taken over")
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str();
  CLI::Option* csv = evaluators->add_flag("--csv", request->csv, "Print CSV instead of tables");
  evaluators->add_flag("--markdown", request->markdown, "Print Markdown instead")->excludes(csv);
  evaluators->add_option("--out", request->out, "Folder for evaluators.html and evaluators.csv");
  evaluators->callback([request, &exit_code] { exit_code = run(*request); });
  return *cost;
}

}  // namespace likeness::cost
