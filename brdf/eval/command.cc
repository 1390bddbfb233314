#include "brdf/eval/command.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include <CLI/CLI.hpp>

#include "brdf/eval/list.h"
#include "brdf/eval/stress.h"
#include "brdf/eval/table.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"

namespace likeness::eval {
namespace {

using files::UsageError;

struct EvalOptions {
  std::string model, in, out, precision;
  std::vector<std::string> assignments;
  double tolerance = std::numeric_limits<double>::infinity(), rows = 1e8;
  std::uint64_t seed = 1;
  int threads = 0;
  bool list = false, json = false, stress = false, markdown = false;
};

std::optional<Precision> precision_of(const EvalOptions& o) {
  if (o.precision.empty()) return std::nullopt;
  for (std::size_t i = 0; i < kPrecisionNames.size(); ++i)
    if (o.precision == kPrecisionNames[i]) return static_cast<Precision>(i);
  throw UsageError("--precision " + o.precision + " is not one of double, float, batch");
}

// The options that only one of the three uses of the command takes.
void refuse_strangers(const CLI::App& app, const char* use, std::initializer_list<const char*> strangers) {
  for (const char* option : strangers)
    if (app.count(option) > 0) throw UsageError(std::string(option) + " does not go with " + use);
}

// Every model, or the one that is named.
std::span<const catalog::Entry> entries_of(const std::string& model) {
  if (model.empty() || model == "all") return catalog::entries();
  return {&entry_named(model), 1};
}

int run_list(const EvalOptions& o) {
  const auto entries = entries_of(o.model);
  std::cout << (o.json ? list_json(entries) : list_text(entries));
  return 0;
}

int run_stress(const EvalOptions& o) {
  StressOptions options;
  if (!(o.rows >= 1 && o.rows <= 1e12)) throw UsageError("--rows must be within [1, 1e12]");
  options.rows = static_cast<std::uint64_t>(o.rows);
  options.seed = o.seed;
  if (const auto precision = precision_of(o)) {
    if (*precision == Precision::kDouble)
      throw UsageError("--precision double: float and batch are held against double; leave the option out for both");
    options.in_float = *precision == Precision::kFloat;
    options.in_batches = *precision == Precision::kBatch;
  }
  files::catch_interrupts();
  static files::Progress* progress = nullptr;  // a plain function hears how far it is
  const auto tell = [](std::string_view what, double share) {
    if (progress != nullptr) progress->tell(what, share);
  };
  std::string csv = stress_csv_header();
  std::size_t unsound = 0;
  std::cout << stress_heading(o.markdown) << std::flush;
  for (const catalog::Entry& entry : entries_of(o.model)) {
    Stressed result;
    {
      files::Progress line;
      progress = &line;
      result = stress(entry, options, tell);
      progress = nullptr;
    }
    std::cout << stress_lines(result, o.markdown) << std::flush;
    csv += stress_csv_lines(result);
    if (!o.out.empty()) files::write_whole(o.out, csv);  // as far as it is: a long run that is ended keeps what it has
    unsound += !result.sound();
  }
  if (unsound > 0)
    std::cerr << "likeness eval: " << unsound << (unsound == 1 ? " model returns" : " models return")
              << " NaN, Inf or a negative value; the rows are named above\n";
  return unsound > 0 ? 1 : 0;
}

int run_eval(const EvalOptions& o) {
  if (o.model.empty()) throw UsageError("MODEL is missing; likeness eval --list prints them");
  TableOptions options{.in = o.in, .out = o.out, .assignments = {}, .tolerance = o.tolerance, .threads = o.threads};
  options.precision = precision_of(o).value_or(Precision::kDouble);
  if (!(o.tolerance >= 0)) throw UsageError("--tolerance must be 0 or more");
  if (o.in.empty() && o.tolerance < std::numeric_limits<double>::infinity())
    throw UsageError("--tolerance compares columns that begin with ref_; give a table of them with --in");
  if (o.threads < 0 || o.threads > 1024)
    throw UsageError("--threads " + std::to_string(o.threads) + " is outside [0, 1024]");
  for (const std::string& text : o.assignments) options.assignments.push_back(assignment_of(text));
  files::catch_interrupts();
  return run_table(entry_named(o.model), options);
}

int run(const CLI::App& app, const EvalOptions& o) {
  try {
    catalog::instruction_set();
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  if (o.list && o.stress) throw UsageError("--list and --stress exclude each other; give one of them");
  if (o.list) {
    refuse_strangers(
        app, "--list",
        {"--in", "--out", "--set", "--precision", "--tolerance", "--threads", "--rows", "--seed", "--markdown"});
    return run_list(o);
  }
  if (o.json) throw UsageError("--json goes with --list only; a table is CSV");
  try {
    if (o.stress) {
      refuse_strangers(app, "--stress", {"--in", "--set", "--tolerance", "--threads"});
      return run_stress(o);
    }
    refuse_strangers(app, "a table; it goes with --stress", {"--rows", "--seed", "--markdown"});
    return run_eval(o);
  } catch (const files::Interrupted&) {
    std::cerr << "likeness eval: interrupted" << (o.out.empty() || o.stress ? "" : "; " + o.out + " is not written")
              << "\n";
    return 130;
  }
}

constexpr auto kFooter = R"(Examples
  likeness eval --list                                    every model, with its inputs and outputs
  likeness eval callisto --set theta_h=0.3 --set roughness=0.2
  likeness eval ggx --in angles.csv --out values.csv      one row of results for each row of inputs
  likeness eval ggx_d --in ref.csv --tolerance 1e-12      compare with the column ref_d; exit code 1 if it differs
  likeness eval --stress callisto --rows 1e6              random inputs: no NaN, no Inf, nothing negative

A table is CSV. Its header names inputs; those it leaves out keep their defaults or what --set gives. A color is one
column (base_color) or three (base_color_r, base_color_g, base_color_b). Outputs are appended with 17 digits.

Exit codes: 0 done, 1 a difference above the tolerance or an unsound result, 2 usage, 3 the table cannot be used (a file
is not written then), 130 interrupted.
Manual: docs/eval.md)";

}  // namespace

void add_eval(CLI::App& program, int& exit_code) {
  const auto o = std::make_shared<EvalOptions>();
  CLI::App* app = program.add_subcommand("eval", "Evaluate any model over a table of inputs, and check it");
  app->add_option("MODEL", o->model, "Name of the model; with --stress also 'all'");

  const std::string table = "A table";
  app->add_option("--in", o->in, "CSV of inputs, - for standard input (without it: one row of defaults)")->group(table);
  app->add_option("--out", o->out, "Where rows and outputs go (default standard output); replaced if it exists")
      ->group(table);
  app->add_option("--set", o->assignments, "NAME=NUMBER or NAME=R,G,B for every row; may be repeated")
      ->allow_extra_args(false)
      ->group(table);
  app->add_option("--precision", o->precision,
                  "double (default), float, or batch: float in SIMD lanes. Inputs are prepared in double")
      ->group(table);
  app->add_option("--tolerance", o->tolerance, "Largest relative difference from the ref_ columns that is no failure")
      ->group(table);
  app->add_option("--threads", o->threads, "Threads; 0: one a core (default). The output does not depend on it")
      ->group(table);

  const std::string list = "What there is";
  app->add_flag("--list", o->list, "Print every model, or MODEL: inputs with range, default and unit, and outputs")
      ->group(list);
  app->add_flag("--json", o->json, "With --list: as JSON")->group(list);

  const std::string stress = "Random inputs";
  app->add_flag("--stress", o->stress,
                "Evaluate MODEL, or all, at random inputs and at edges, in float and in batches against double")
      ->group(stress);
  app->add_option("--rows", o->rows, "Rows a model (default 1e8); slow models get as many as 2 us of CPU a row allow")
      ->group(stress);
  app->add_option("--seed", o->seed, "Of the random inputs (default 1)")->group(stress);
  app->add_flag("--markdown", o->markdown, "Print the result as a Markdown table; --out writes it as CSV")
      ->group(stress);
  app->footer(kFooter);
  app->callback([o, app, &exit_code] { exit_code = run(*app, *o); });
}

}  // namespace likeness::eval
