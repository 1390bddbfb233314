#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fit/measured/measured.h"

namespace likeness::measured {

// `likeness convert`.
struct ConvertOptions {
  std::filesystem::path in, out;  // out ends in .binary (MERL) or .csv
  bool json = false;              // the report as JSON instead of text
};

// What became of the data.
struct Conversion {
  Coverage in, out;
  Format from = Format::kMerl, to = Format::kMerl;
  bool resampled = false;     // values were looked up or interpolated at other directions than the stored ones
  double directions_in = 0;   // share of all pairs of directions above the horizon that the samples stand for [1]
  double directions_out = 0;  // the same of what was written
  // The written file, read back and evaluated at every sample of the source: 100 |g - f| / (f + 0.001) of the worst
  // channel, [%].
  double median_pct = 0, worst_pct = 0;
  std::size_t compared = 0, lost = 0;  // samples of the source; those at which the written file has no value
};

// The MERL table of a material: its value at every bin centre, -1 where it has none. Takes all cores; the numbers do
// not depend on how many.
std::vector<Rgb> merl_table_of(const Material& material);

// Reads, writes whole or not at all, reads back and compares. Throws files::UsageError for an output name of another
// extension or the input itself, files::InputError for the input, std::runtime_error if `out` cannot be written.
Conversion convert(const ConvertOptions& options);

// convert(), and the report on standard output. Returns the exit code, 0.
int run_convert(const ConvertOptions& options);

// The report, a few lines or one JSON object.
std::string text_of(const Conversion& conversion, const ConvertOptions& options);
std::string json_of(const Conversion& conversion, const ConvertOptions& options);

}  // namespace likeness::measured
