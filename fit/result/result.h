#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "brdf/any_brdf.h"
#include "fit/measured/measured.h"

// What a fit finds. Plain values: the solver fills them, result_file.h writes them, report.h draws them.
namespace likeness::fit {

enum class Domain { kSlice, kTable };  // what the loss sums over
enum class Loss { kLog, kCubeRoot };

struct Options {
  std::string model = "callisto";
  brdf::Tier tier = brdf::Tier::kFull;
  Domain on = Domain::kSlice;
  Loss loss = Loss::kLog;
  double cut_deg = 80;  // samples with theta_i or theta_o above it are not used
  int starts = 0;       // 0: the model's own number
  int threads = 0;      // 0: one a core; the numbers do not depend on it
};

// A model against a measured material. Definitions: docs/fit.md.
struct Metrics {
  double slice_error_pct = 0;  // 100 sqrt(mean (clamp01 f - clamp01 g)^2), standard slice
  double slice_log_rms = 0;    // RMS of ln(1 + f cos_i) - ln(1 + g cos_i), standard slice
  // The same two with the model at the grid's directions although a table's value holds at the centre of the nearest
  // bin, as published numbers have it. Equal to the above for formats that interpolate.
  double slice_error_pct_at_grid = 0, slice_log_rms_at_grid = 0;
  double log_rms_3d = 0;                            // the same over the whole table, weighted by solid angle
  measured::Rgb albedo_reference, albedo_model;     // bihemispherical reflectance within the cut [1]
  double sphere_psnr = 0;                           // [dB], two spheres lit at 30 and 120 degrees, displayed in sRGB
  double sphere_ssim = 0;                           // the same pictures
  std::size_t slice_samples = 0, slice_grid = 0;    // used, of 90 x 90
  std::size_t table_samples = 0, table_stored = 0;  // used, of those stored
};

// One channel of one parameter.
struct Estimate {
  std::string name;  // of the parameter's row
  int channel = -1;  // 0, 1, 2: r, g, b; -1: the parameter has one channel
  double value = 0;
  double sigma = 0;     // standard deviation from the covariance of the fit; NaN where it does not matter
  bool fitted = false;  // false: left at its default by the tier
  bool at_bound = false;
  bool matters = true;  // false: the material's data do not depend on it
  std::string why;      // why it does not matter
};

// One evaluation of the loss on the way to the best optimum.
struct Step {
  int iteration = 0;
  double loss = 0;
};

// A model with parameters, and how near it comes: the fit itself, a baseline, or the talk's hand set.
struct Candidate {
  std::string label;  // "Callisto, full tier"
  brdf::AnyBrdf brdf;
  Metrics metrics;
  double loss = 0;                   // the fitted loss; comparable between candidates of one result
  std::vector<Estimate> estimates;   // empty for a hand set
  std::vector<Step> convergence;     // of the winning start
  std::vector<double> start_losses;  // final loss of every start, in the order of the starts
  int best_start = -1;
  double cpu_seconds = 0;
};

// The pattern of a slice, after the talk's sorting of MERL: the fitted diffuse towards the edges against its
// middle, in stops; the group is the sign pattern.
struct Pattern {
  double fresnel_stops = 0;          // top of the slice: > 0 brighter
  double retroreflection_stops = 0;  // right of the slice
  double corner_stops = 0;           // top right: < 0 dark, a smooth terminator
  std::string group;                 // "Fresnel brighter, retroreflection darker, dark corner"
};

struct Timing {
  double load = 0, fit = 0, baselines = 0, metrics = 0, report = 0;  // CPU seconds
};

struct Result {
  std::string material;  // file name without extension
  std::string source;    // as the user named it
  std::string sha256;    // of the input file
  measured::Format format = measured::Format::kMerl;
  measured::Coverage coverage;
  Options options;
  Candidate best;
  std::vector<Candidate> baselines;   // Lambert + GGX, poorer tiers, Disney 2012, ...
  std::optional<Candidate> hand_set;  // the talk's, where the material is one of its ten
  std::optional<Candidate> hand_set_disney;
  Pattern pattern;
  std::vector<std::string> notes;  // what the user should know before using it; whole sentences
  Timing timing;
};

}  // namespace likeness::fit
