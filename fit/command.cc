#include "fit/command.h"

#include <unistd.h>

#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <CLI/CLI.hpp>

#include "fit/batch.h"
#include "fit/fit.h"
#include "fit/kernel.h"
#include "fit/result_file.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"

namespace likeness::fit {

namespace {

struct FitOptions {
  std::vector<std::string> paths;
  Options fit;
  std::string tier = "full", on = "slice", loss = "log", out = "likeness_fit";
  bool json = false;
};

// One line that is rewritten on a terminal, one line a material elsewhere.
void tell(const BatchProgress& p) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  std::ostringstream line;
  line << p.done << "/" << p.all << "  " << p.material << ": " << p.outcome;
  if (p.done < p.all && std::isfinite(p.seconds_left))
    line << "; about " << files::duration_text(p.seconds_left) << " left";
  if (terminal) std::cerr << "\r\x1b[K" << line.str() << (p.done == p.all ? "\n" : "") << std::flush;
  else std::cerr << line.str() << "\n";
}

// A single material that takes more than a moment (every sample of a table: half a minute) says what it is at.
void tell_model(const std::string& label) {
  if (isatty(STDERR_FILENO) != 0) std::cerr << "\r\x1b[Kfitting " << label << std::flush;
}
void end_of_models() {
  if (isatty(STDERR_FILENO) != 0) std::cerr << "\r\x1b[K" << std::flush;
}

void print_candidate(const Candidate& c) {
  const auto error = [](double a, double b) { return std::abs(a - b); };
  const Metrics& m = c.metrics;
  const double albedo =
      std::max({error(m.albedo_model.r, m.albedo_reference.r), error(m.albedo_model.g, m.albedo_reference.g),
                error(m.albedo_model.b, m.albedo_reference.b)});
  std::cout << "  " << std::left << std::setw(30) << c.label << std::right << std::fixed << std::setprecision(2)
            << std::setw(9) << m.slice_error_pct << " %" << std::setprecision(4) << std::setw(12) << m.slice_log_rms
            << std::setw(12) << m.log_rms_3d << std::setw(12) << albedo << "\n"
            << std::defaultfloat;
}

void print_result(const Result& r, const std::filesystem::path& base) {
  std::cout << r.material << ": " << r.coverage.valid << " of " << r.coverage.stored << " samples valid; slice within "
            << r.options.cut_deg << " deg: " << r.best.metrics.slice_samples << " of " << r.best.metrics.slice_grid
            << "; " << r.pattern.group << "\n\n  " << std::left << std::setw(30) << "" << std::right << std::setw(11)
            << "slice error" << std::setw(12) << "slice log" << std::setw(12) << "3-D log" << std::setw(12)
            << "albedo err" << "\n";
  print_candidate(r.best);
  for (const Candidate& c : r.baselines) print_candidate(c);
  for (const auto* c : {&r.hand_set, &r.hand_set_disney})
    if (c->has_value()) print_candidate(**c);
  for (const std::string& note : r.notes) std::cout << "\n  Note: " << note << "\n";
  std::cout << "\n  report    " << base.string() << ".html\n  material  " << base.string()
            << ".material.json\n  numbers   " << base.string() << ".fit.json\n";
}

int run_fit(FitOptions& o) {
  const auto choose = [](const char* option, const std::string& value, auto& out, auto... rows) {
    bool found = false;
    std::string names;
    const auto consider = [&](const auto& row) {
      names += (names.empty() ? "" : ", ") + std::string(row.first);
      if (value == row.first) {
        out = row.second;
        found = true;
      }
    };
    (consider(rows), ...);
    if (!found) throw files::UsageError(std::string(option) + " " + value + " is not one of " + names);
  };
  using brdf::Tier;
  const bool tiered = o.fit.model == "callisto";
  choose("--tier", o.tier, o.fit.tier, std::pair{"base", Tier::kBase}, std::pair{"advanced", Tier::kAdvanced},
         std::pair{"full", Tier::kFull});
  if (!tiered && o.fit.tier != Tier::kFull)
    throw files::UsageError("--tier " + o.tier + ": model " + o.fit.model + " has no tiers; leave the option out");
  choose("--on", o.on, o.fit.on, std::pair{"slice", Domain::kSlice}, std::pair{"table", Domain::kTable});
  choose("--loss", o.loss, o.fit.loss, std::pair{"log", Loss::kLog}, std::pair{"cuberoot", Loss::kCubeRoot});
  check(o.fit);
  kernels();  // an impossible instruction set is said before anything is read

  const std::vector<Job> jobs = jobs_of(o.paths);
  files::catch_interrupts();
  const std::filesystem::path out = o.out;
  const BatchResult batch =
      run_batch(jobs, o.fit, out, files::interrupted, jobs.size() > 1 ? tell : nullptr, tell_model);
  if (jobs.size() == 1) end_of_models();

  if (batch.interrupted) {
    std::cerr << "\nlikeness: interrupted; " << batch.rows.size() << " of " << jobs.size() << " finished are in "
              << out.string() << "; the same command goes on from there\n";
    return 130;
  }
  if (jobs.size() == 1) {
    if (!batch.failed.empty()) throw files::InputError(batch.failed.front().message);
    if (o.json) std::cout << result_json(batch.results.front());
    else print_result(batch.results.front(), out / jobs.front().name);
    return 0;
  }
  double slice = 0, log = 0;
  for (const OverviewRow& row : batch.rows) {
    slice += row.metrics.slice_error_pct;
    log += row.metrics.slice_log_rms;
  }
  const double count = static_cast<double>(std::max<std::size_t>(batch.rows.size(), 1));
  if (o.json) {
    std::cout << batch_json(batch, out);
  } else {
    std::cout << batch.rows.size() << " materials fitted";
    if (batch.taken_over > 0) std::cout << " (" << batch.taken_over << " taken over from an earlier run)";
    std::cout << std::fixed << std::setprecision(2) << "; mean slice error " << slice / count
              << " %, mean slice log RMS " << std::setprecision(4) << log / count << "\n  overview  "
              << (out / "index.html").string() << "\n";
  }
  for (const FailedFile& f : batch.failed) std::cerr << "likeness: " << f.message << "\n";
  return batch.failed.empty() ? 0 : 3;
}

std::string model_list() {
  std::string out;
  for (const std::string_view name : fitted_models()) out += (out.empty() ? "" : ", ") + std::string(name);
  return out;
}

}  // namespace

CLI::App& add_fit(CLI::App& program, int& exit_code) {
  const auto o = std::make_shared<FitOptions>();
  CLI::App* app = program.add_subcommand(
      "fit",
      "Find the parameters of a model that match a measured material, with proof.\n\n"
      "Fits the standard BRDF slice of each file (MERL .binary, NVIDIA .mbsdf, RGL .bsdf, CSV), then writes a\n"
      "report to look at, a material file to render with, and all numbers as JSON. A folder is a batch: it can\n"
      "be interrupted at any moment and goes on where it was when the same command is given again.");
  app->add_option("FILE", o->paths, "measured materials, or folders of them");
  app->add_option("--model", o->fit.model, "model to fit: " + model_list())->capture_default_str();
  app->add_option("--tier", o->tier,
                  "parameters of Callisto to fit: base (artists), advanced (+ tints, second lobe), full (all)")
      ->capture_default_str();
  app->add_option("--on", o->on,
                  "what to fit: slice (the standard slice, as the talk does) or table (every valid sample)")
      ->capture_default_str();
  app->add_option("--cut", o->fit.cut_deg, "largest angle of light and viewer to the normal that is used [deg]")
      ->capture_default_str();
  app->add_option("--loss", o->loss, "log: of 1 + f cos, with what a display shows at half weight; cuberoot: of f cos")
      ->capture_default_str();
  app->add_option("--starts", o->fit.starts, "searches begun at different places; 0: the model's own number")
      ->capture_default_str();
  app->add_option("--threads", o->fit.threads, "threads; 0: one a core. The numbers do not depend on it")
      ->capture_default_str();
  app->add_option("--out", o->out, "folder for reports, material files and numbers")->capture_default_str();
  app->add_flag("--json", o->json, "print the result file (of a batch: its summary) instead of a table");
  app->footer(
      "Examples\n"
      "  likeness fit gold.binary\n"
      "  likeness fit materials/ --out out/all\n"
      "  likeness fit paint.mbsdf --on table --tier advanced --json\n\n"
      "Exit codes: 0 done, 2 usage, 3 a file could not be used (a batch goes on past it), 130 interrupted.\n"
      "What the numbers mean: docs/fit.md");
  app->callback([o, app, &exit_code] {
    if (!app->get_subcommands().empty()) {  // the photographs of a capture, which have a command of their own
      if (!o->paths.empty())
        throw files::UsageError(o->paths.front() +
                                ": measured materials and a capture are fitted by two commands; a folder "
                                "that is called like the subcommand is ./" +
                                app->get_subcommands().front()->get_name());
      return;
    }
    if (o->paths.empty())
      throw files::UsageError("FILE is required: a measured material, or a folder of them (likeness fit --help)");
    exit_code = run_fit(*o);
  });
  return *app;
}

}  // namespace likeness::fit
