#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "brdf/cost/accuracy.h"
#include "brdf/cost/ladder.h"
#include "brdf/cost/timing.h"

// The whole measurement: what accuracy costs in time.
namespace likeness::cost {

struct Options {
  std::vector<std::string> families;  // names; empty: all
  int repeats = 15;
  double seconds = 0.004;  // CPU time of one reading
  double draws_scale = 1;  // times each family's number of draws
};

// One form in one precision.
struct Cell {
  Timing timing;  // NaN if one_by_one: what a row costs is what it costs in float
  Accuracy accuracy;
  bool one_by_one = false;  // a batch that its evaluator takes apart, because it has branches: no form for batches
  // Another form of the family in the same precision that is no less exact, and faster by more than the quartiles of
  // both; empty: none is.
  std::string dominated_by;
};

struct FamilyResult {
  Family family;
  std::size_t draws = 0;
  double noise = 0;  // of a random reference: its RMS over the reference's. Smaller errors cannot be told from 0.
  std::vector<std::array<Cell, 3>> cells;  // one for each rung; double, float, batch
};

struct Study {
  Machine machine;
  Options options;
  double seconds = 0;  // CPU time of the whole
  std::vector<FamilyResult> families;
};

// Marks the forms of a family to which another is preferable, one precision at a time.
void find_dominated(FamilyResult& result);

// The families of these names, all if there are none. Throws std::invalid_argument for a family that there is not, and
// names those that there are.
std::vector<Family> chosen_families(const std::vector<std::string>& names);

// `progress` is told what is being done and the share of all that is done; what it throws ends the study. Throws
// as chosen_families does.
Study run_study(const Options& options, const std::function<void(const std::string&, double)>& progress);

// One line for each form and precision.
std::string csv_of(const Study& study);
// A Markdown table for each family, as docs/cost.md has them.
std::string markdown_of(const Study& study);
// For the terminal.
std::string table_of(const Study& study);
// One self-contained HTML page with a plot for each family.
std::string page_of(const Study& study);

}  // namespace likeness::cost
