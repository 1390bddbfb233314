#include "datasets_synthetic/command.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include <CLI/CLI.hpp>

#include "datasets_synthetic/capture_command.h"
#include "datasets_synthetic/material.h"
#include "datasets_synthetic/scene_command.h"
#include "render/files/files.h"
#include "render/material/material_file.h"
#include "render/material/parameters.h"

namespace likeness::datasets_synthetic {
namespace {

using files::UsageError;
using material::in_quotes;
using material::number_text;
using measured::Format;

constexpr std::array<std::string_view, 3> kFormats{"merl", "mbsdf", "csv"};
constexpr std::array kFormatOf{Format::kMerl, Format::kMbsdf, Format::kCsv};  // in the order of kFormats

struct MakeOptions {
  std::string model, from, format, out;
  std::vector<std::string> assignments;  // "name=number[,number,number]"
  bool random = false, list = false, json = false;
  std::uint64_t seed = 0;
  int count = 1;
  int theta_bins = 0, phi_bins = 0;  // 0: the format's own
  Faults faults;
};

[[noreturn]] void refuse(const std::string& text) { throw UsageError(text); }

std::string near(std::string_view wanted, std::span<const std::string_view> names) {
  const std::string found = files::nearest_name(wanted, names.data(), names.size());
  return found.empty() ? "" : "; did you mean " + found + "?";
}

void require_within(std::string_view option, double value, brdf::Interval range, std::string_view text) {
  if (value >= range.low && value <= range.high) return;  // false for NaN
  refuse("--" + std::string(option) + " = " + number_text(value) + " is outside [" + number_text(range.low) + ", " +
         number_text(range.high) + "] (" + std::string(text) + ")");
}

std::vector<double> numbers_in(std::string_view text, const std::string& assignment) {
  std::vector<double> out;
  while (true) {
    const std::string_view one = text.substr(0, text.find(','));
    double value = 0;
    const auto [end, error] = std::from_chars(one.data(), one.data() + one.size(), value);
    if (error != std::errc{} || end != one.data() + one.size())
      refuse("--set " + in_quotes(assignment) + ": " + in_quotes(one) +
             " is not a number; write roughness=0.3 or base_color=0.5,0.2,0.1");
    out.push_back(value);
    if (one.size() == text.size()) return out;
    text.remove_prefix(one.size() + 1);
  }
}

// "name=numbers" put into the model; one number stands for all three channels of a color.
void assign_text(brdf::AnyBrdf& brdf, const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos)
    refuse("--set " + in_quotes(assignment) + " has no '='; write roughness=0.3 or base_color=0.5,0.2,0.1");
  const std::string name = assignment.substr(0, equals);
  std::vector<double> channels = numbers_in(std::string_view(assignment).substr(equals + 1), assignment);
  for (const material::Entry& entry : material::entries(brdf))
    if (entry.row.name == name && channels.size() == 1)
      channels.assign(static_cast<std::size_t>(entry.row.channels), channels[0]);
  const std::string wrong = material::assign(brdf, name, channels);
  if (!wrong.empty()) refuse("--set " + wrong);
}

brdf::AnyBrdf model_asked(const MakeOptions& options) {
  if (!options.from.empty() && !options.model.empty())
    refuse("--from and --model exclude each other; give one of them");
  if (!options.from.empty()) return material::read_material(options.from).brdf;
  brdf::AnyBrdf brdf;
  if (!options.model.empty() && !brdf::model_of_name(options.model, brdf))
    refuse("--model: " + material::no_such_model(options.model));
  return brdf;
}

Format format_asked(const MakeOptions& options) {
  const std::string extension = std::filesystem::path(options.out).extension().string();
  std::optional<Format> by_name, by_extension;
  for (std::size_t i = 0; i < kFormats.size(); ++i) {
    if (options.format == kFormats[i]) by_name = kFormatOf[i];
    if (extension == extension_of(kFormatOf[i])) by_extension = kFormatOf[i];
  }
  if (!options.format.empty() && !by_name)
    refuse("--format " + in_quotes(options.format) + " is unknown" + near(options.format, kFormats) +
           " (formats: merl, mbsdf, csv)");
  if (by_name && by_extension && by_name != by_extension)
    refuse("--out " + in_quotes(options.out) + " does not go with --format " + options.format +
           ", which is written as " + std::string(extension_of(*by_name)) + "; change one of them");
  return by_name ? *by_name : by_extension.value_or(Format::kMerl);
}

Grid grid_asked(const MakeOptions& options, Format format) {
  constexpr int kMostTheta = 180, kMostPhi = 360;  // 11.7 million samples
  if (format == Format::kMerl) {
    if (options.theta_bins != 0 || options.phi_bins != 0)
      refuse("--theta-bins and --phi-bins are for mbsdf and csv; a MERL file always has 90 x 90 x 180");
    return grid_of(format, 0, 0);
  }
  const int theta = options.theta_bins != 0 ? options.theta_bins : format == Format::kCsv ? 30 : 45;
  const int phi = options.phi_bins != 0 ? options.phi_bins : format == Format::kCsv ? 60 : 90;
  require_within("theta-bins", theta, {2, kMostTheta}, "bins over 90 deg");
  require_within("phi-bins", phi, {2, kMostPhi}, "bins over 180 deg");
  return grid_of(format, theta, phi);
}

void print_table(const brdf::AnyBrdf& brdf, std::ostream& out) {
  out << "Parameters of " << material::model_name(brdf) << ": name, range, usual range, default, tier, meaning\n";
  for (const material::Entry& entry : material::entries(brdf)) {
    const brdf::Parameter& row = entry.row;
    const auto interval = [](const brdf::Interval& range) {
      return "[" + number_text(range.low) + ", " + number_text(range.high) + "]";
    };
    const auto column = [&](std::string text, std::size_t width) {
      out << text.append(width > text.size() ? width - text.size() : 1, ' ');
    };
    out << "  ";
    column(std::string(row.name), 34);
    column(interval(row.range) + (row.channels == 3 ? "^3" : ""), 11);
    column(interval(row.typical), 13);
    column(number_text(row.initial) + (row.unit == "1" ? "" : " " + std::string(row.unit)), 6);
    column(std::string(brdf::kTierNames[static_cast<std::size_t>(row.tier)]), 10);
    out << row.text << '\n';
  }
}

// Where the material of that seed goes: the file that --out names, or a file in the folder that it names.
std::filesystem::path file_asked(const MakeOptions& options, Format format, std::string_view model,
                                 std::uint64_t seed) {
  std::filesystem::path out = options.out;
  if (out.extension() == extension_of(format)) return out;
  return out / (std::string(model) + "_" + std::to_string(seed) + std::string(extension_of(format)));
}

void run_make(const MakeOptions& options, std::ostream& out) {
  brdf::AnyBrdf brdf = model_asked(options);
  if (options.list) return print_table(brdf, out);
  if (options.out.empty()) refuse("--out is missing: a file ending in .binary, .mbsdf or .csv, or a folder");
  const Format format = format_asked(options);
  Material material{brdf, grid_asked(options, format), options.faults, 0};
  for (const FaultRow& row : kFaults) require_within(row.name, options.faults.*row.value, row.range, row.text);
  require_within("count", options.count, {1, 10'000}, "materials to make");
  if (options.faults.noise_by_angle && options.faults.noise == 0)
    refuse("--noise-by-angle has no noise to shape; add --noise 0.1");
  const bool one_file = std::filesystem::path(options.out).extension() == extension_of(format);
  if (options.count > 1 && one_file)
    refuse("--count " + std::to_string(options.count) + " needs a folder for --out; " + in_quotes(options.out) +
           " is one file");

  std::string separator;
  if (options.json) out << "[";
  for (int n = 0; n < options.count; ++n) {
    material.seed = options.seed + static_cast<std::uint64_t>(n);
    material.brdf = options.random ? drawn(brdf, material.seed) : brdf;
    for (const std::string& assignment : options.assignments) assign_text(material.brdf, assignment);
    const std::filesystem::path file = file_asked(options, format, material::model_name(brdf), material.seed);
    std::string manifest = write(material, file);
    if (options.json) {
      manifest.pop_back();  // the newline
      out << separator << manifest;
      separator = ",\n";
    } else {
      out << file.string() << " (truth: " << file.stem().string() << ".truth.json, " << file.stem().string()
          << material::kExtension << ")\n"
          << std::flush;
    }
  }
  if (options.json) out << "]\n";
}

constexpr auto kFooter = R"(Beside every file lie NAME.truth.json, which says what is in it (parameters, faults, how
many samples each changed, hash), and NAME.material.json, the parameters as a material file. The same options and the
same seed give the same bytes.

Examples
  likeness make material --set roughness=0.3 --set base_color=0.5,0.2,0.1 --out red.binary
  likeness make material --random --seed 1 --count 10 --out materials/
  likeness make material --from gold.material.json --invalid 0.25 --nan 0.01 --noise 0.1 --out worn.binary
  likeness make material --model disney2012 --list
Manual: docs/make_material.md)";

}  // namespace

void add_make(CLI::App& program, int& exit_code) {
  CLI::App* make = program.add_subcommand("make", "Make synthetic data whose truth is known");
  make->require_subcommand(1);
  CLI::App* sub = make->add_subcommand(
      "material",
      "Write measured-material files from a model with known parameters and, if asked, the faults of real data");
  auto options = std::make_shared<MakeOptions>();

  const std::string model = "Model";
  std::string models;
  for (const std::string_view name : brdf::kModelNames) models += (models.empty() ? "" : ", ") + std::string(name);
  sub->add_option("--model", options->model, "Evaluator: " + models + " (default callisto)")->group(model);
  sub->add_flag("--list", options->list, "Print the model's parameters and make nothing")->group(model);
  sub->add_option("--from", options->from, "Take model and parameters from a material file")->group(model);
  sub->add_flag("--random", options->random, "Draw every parameter from its usual range, with the seed")->group(model);
  sub->add_option("--set", options->assignments,
                  "NAME=NUMBER or NAME=R,G,B; may be repeated, and comes after --from and --random")
      ->allow_extra_args(false)
      ->group(model);

  const std::string output = "Output";
  sub->add_option("--out", options->out, "A file ending in .binary, .mbsdf or .csv, or else a folder")->group(output);
  sub->add_option("--format", options->format, "merl, mbsdf or csv (default: by --out, else merl)")->group(output);
  sub->add_option("--theta-bins", options->theta_bins, "mbsdf, csv: bins over 90 deg of theta (default 45, 30)")
      ->group(output);
  sub->add_option("--phi-bins", options->phi_bins, "mbsdf, csv: bins over 180 deg of phi (default 90, 60)")
      ->group(output);
  sub->add_option("--count", options->count, "Make that many, with seeds seed, seed + 1, ... (needs a folder)")
      ->group(output);
  sub->add_option("--seed", options->seed, "Of --random and of the faults (default 0)")->group(output);
  sub->add_flag("--json", options->json, "Print the manifests as a JSON list instead of one line a file")
      ->group(output);

  const std::string faults = "Faults of real data (shares are of the samples above the horizon)";
  const Faults none;
  for (const FaultRow& row : kFaults)
    sub->add_option("--" + std::string(row.name), options->faults.*row.value,
                    std::string(row.text) + ", " + number_text(row.range.low) + " to " + number_text(row.range.high) +
                        " (default " + number_text(none.*row.value) + ")")
        ->group(faults);
  sub->add_flag("--noise-by-angle", options->faults.noise_by_angle,
                "Noise grows as 1 / sqrt of the smaller cosine of light and viewer, as photons become few")
      ->group(faults);
  sub->add_flag("--half-bin", options->faults.half_bin,
                "Sample at the lower edges of the bins, where readers expect the centers")
      ->group(faults);
  sub->add_option("--truncate", options->faults.truncate, "Bytes to cut from the end of the file")->group(faults);

  sub->footer(kFooter);
  sub->callback([options, &exit_code] {
    run_make(*options, std::cout);
    exit_code = 0;
  });
  add_make_scene(*make, exit_code);
  add_make_capture(*make, exit_code);
}

}  // namespace likeness::datasets_synthetic
