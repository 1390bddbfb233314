#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "datasets_synthetic/capture.h"
#include "datasets_synthetic/random.h"
#include "realis/bake.h"

// What each weight is worth: synthetic captures of which the truth is known, baked with a fault and without, with the
// weight and without (spec: Realis, What must be shown; docs/realis_weights.md).
namespace likeness::realis {

// A fault, of a size that the draw decides, in a capture of so many lights; and the weight that is there for it (empty:
// none is, and what is measured are those that are on by default).
struct Fault {
  std::string_view name, weight;
  void (*plant)(datasets_synthetic::CaptureOptions& options, datasets_synthetic::Random& draw);
  std::string_view text;
};
// The only statement of the faults: table, page, CSV, JSON, docs and tests come from it.
extern const std::array<Fault, 10> kFaults;

struct AblationOptions {
  std::filesystem::path folder;  // for captures, which are taken away again
  std::vector<std::size_t> lights{12, 32, 96};
  std::size_t seeds = 5, first_seed = 1;
  int side = 64;                    // [pixel]
  double full_well = 20000;         // of every capture; 0: no noise
  std::vector<std::string> faults;  // names; none: all
};

// One fault under one seed.
struct Trial {
  std::size_t fault = 0;  // in kFaults
  std::size_t lights = 0, seed = 0;
  double touched = 0;                            // share of the texels that the fault touches
  double false_residual = 0, left = 0;           // rms over those texels and all directions [unit of the photo]
  double false_of_lobes = 0, left_of_lobes = 0;  // the same with the lobes of the capture without the fault
  double best = 0;  // what weights leave that know the truth: 1 / (1 + (d / t)^2), d the sample's fault, of the best t
  double held_out_clean = 0, held_out_without = 0, held_out_with = 0;  // rms against photographs without fault or noise
  double removed() const { return false_residual > 0 ? 1 - left / false_residual : 0; }
};

// One weight on a capture without faults, under one seed.
struct Cost {
  std::string_view weight;
  std::size_t lights = 0, seed = 0;
  double size = 0;     // of what is baked: rms over texels and directions [unit of the photo]
  double changed = 0;  // of it, relative
  double noise = 0;    // the same of a capture that differs by its noise only
  double touched = 0;  // share of the samples that weigh less than 1
  double held_out_without = 0, held_out_with = 0;
};

struct Ablation {
  std::vector<Trial> trials;
  std::vector<Cost> costs;
};

// Of all seeds of a fault or weight under so many lights: the median, and the ends.
struct Spread {
  double least = 0, median = 0, most = 0;
};
Spread spread_of(std::vector<double> values);

std::string table_of(const Ablation& ablation);
std::string csv_of(const Ablation& ablation);
std::string json_of(const Ablation& ablation);
std::string page_of(const Ablation& ablation, const AblationOptions& options);

// Throws files::UsageError for a fault that is none, files::Interrupted.
Ablation ablate(const AblationOptions& options, const GoesOn& goes_on);

}  // namespace likeness::realis
