#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/catalog/catalog.h"

// Random inputs by the million through an evaluator: nothing may be NaN, infinite or negative, and float and batches
// are held against double from the same floats.
namespace likeness::eval {

inline constexpr double kErrorFloor = 1e-30;  // results below it count as that when errors are made relative
// Rows with an input below it, if its range reaches 0, are checked but not compared: what is divided by two cosines is
// kept above 1e-18 in float and above 1e-150 in double (brdf/scalar.h), so the two differ by design.
inline constexpr float kLeastCompared = 1e-9f;
inline constexpr double kErrorDemand = 2e-5;  // rows above it are counted
inline constexpr double kLeastUlps = 16;      // errors below that many units of the inputs are not told apart

struct StressOptions {
  std::uint64_t rows = 100'000'000;  // fewer if they take more than kCostLimit each
  std::uint64_t seed = 1;
  bool in_float = true, in_batches = true;
};
inline constexpr double kCostLimit = 2e-6;  // [CPU s], all precisions, drawing and comparing included

// A row worth keeping.
struct Found {
  double value = 0;         // what made it worth keeping
  std::string_view output;  // the name of its worst output
  double got = 0, want = 0;
  std::vector<float> inputs;  // empty: there is none
};

// One precision of one evaluator.
struct Swept {
  std::string_view precision;
  std::uint64_t not_finite = 0, negative = 0;
  std::uint64_t compared = 0;  // rows: not those with an input below kLeastCompared
  Found bad;                   // the first row of these
  Found worst;                 // by |got - want| / max(|want|, kErrorFloor)
  std::uint64_t over = 0;      // compared rows whose error is above kErrorDemand
  // By the error in units of what is uncertain: the sum of what one ulp of each input changes (in double), and half an
  // ulp of the result. Near 1 nobody can do better with these inputs. kLeastUlps where nothing exceeds that.
  Found ulps;
  std::array<std::uint64_t, 1024> histogram{};  // of the errors, eight bins an octave
  double seconds = 0;                           // [CPU s] in the loop itself, all threads together

  // The error that this share of the rows does not exceed, to an eighth of an octave.
  double quantile(double share) const;
  void add(const Swept& next);
};

struct Stressed {
  const catalog::Entry* entry = nullptr;
  std::uint64_t rows = 0;
  std::vector<Swept> precisions;  // double first

  bool sound() const;  // nothing was NaN, infinite or negative
};

// Evaluates rows on all cores, in order, until all are done or as much time is used up as all may take. Which rows these
// are depends on entry and seed only, how many of a slow evaluator on the machine. `tell` hears how far it is. Throws
// files::Interrupted.
Stressed stress(const catalog::Entry& entry, const StressOptions& options, void (*tell)(std::string_view, double));

// As a line of a table: text for people (with where the worst row is), Markdown, or CSV.
std::string stress_heading(bool markdown);
std::string stress_lines(const Stressed& result, bool markdown);
std::string stress_csv_header();
std::string stress_csv_lines(const Stressed& result);

}  // namespace likeness::eval
