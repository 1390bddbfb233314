#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "olat/metric/metric.h"
#include "olat/pair/state.h"
#include "render/capture/capture.h"

// Every metric of every pair of a capture: photo and render of one camera under one light.
namespace likeness::olat_compare {

using olat_pair::Choice;
using olat_pair::kMatches;  // what a render is multiplied by before it is compared
using olat_pair::Match;

// What a pixel counts, inside the mask and where the photo is neither clipped nor NaN.
enum class Weight : unsigned char { kMask, kCosine };
inline constexpr std::array kWeights{
    Choice{"mask", "1"},
    Choice{"cosine", "max(0, N.L): needs normals and directions of lights; grazing light counts less"},
};

struct Options {
  std::string variant;                  // id; empty: the first that has renders
  std::vector<metric::Metric> metrics;  // empty: all
  Match match = Match::kNone;
  Weight weight = Weight::kMask;
  std::vector<std::string> cameras, lights;                             // ids; empty: all
  std::string view;                                                     // empty: the capture's
  double ev = 0;                                                        // on top of the capture's [stop]
  std::string cache;                                                    // file of results to go on from; empty: none
  std::function<bool(std::string_view what, double share)> keep_going;  // false: stop
};

enum class State : unsigned char { kCompared, kNoRender, kOtherSize, kUnreadable, kNotReached };
inline constexpr std::array<std::string_view, 5> kStates{"compared", "no render", "other size", "unreadable",
                                                         "not reached"};

struct Row {
  std::size_t camera = 0, light = 0;
  State state = State::kNotReached;
  std::string fault;                       // of what cannot be compared
  std::array<double, 3> gain_ev{};         // that the render was multiplied by [stop]
  double weight = 0;                       // sum over the pixels
  std::size_t clipped = 0;                 // pixels inside the mask that were left out
  std::vector<metric::Summary> summaries;  // of Comparison::metrics
};

struct Comparison {
  std::string variant, view;
  double ev = 0;
  Match match = Match::kNone;
  Weight weight = Weight::kMask;
  std::vector<metric::Metric> metrics;
  std::vector<std::array<double, 3>> noise_floor;  // of each camera, that was used
  std::vector<bool> noise_is_measured;             // here, from the photos, because cameras.json does not say
  std::vector<Row> rows;                           // by camera, then light
  std::size_t from_cache = 0;                      // metrics of pairs that were not computed anew
  bool is_complete = true;
};

// Pairs are shared among TBB's threads; each holds its two pictures and the planes of one metric (FLIP: about 25 floats a
// pixel). The result does not depend on the number of threads, nor on what came from the cache. Files that cannot be used
// are rows with their fault. Throws files::UsageError: an id that the capture does not have; cosine without normals;
// files::InputError: an unknown view.
Comparison run_compare(const capture::Capture& capture, const Options& options);

// Of many pairs: what is weighed by pixels (mean, rms), the median of medians and of 95th percentiles, the largest.
metric::Summary total(const std::vector<const metric::Summary*>& summaries);

// A limit on a statistic of each pair, "stops.p95=0.5"; "0.5" alone is one on stops.p95. Magnitudes are compared.
struct Limit {
  metric::Metric metric = metric::Metric::kStops;
  std::size_t statistic = 2;  // of metric::kStatistics
  double most = 0;
};
Limit limit_of(std::string_view text);  // throws files::UsageError

// As idiff: 0 within the limits, 1 a warning limit is passed, 2 a failing one, 3 a size differs, 4 a file cannot be used
// or there is no pair; the largest that applies.
// A limit on a metric that was not asked for is passed by nobody.
enum ExitCode { kWithin = 0, kWarn = 1, kFail = 2, kSizeDiffers = 3, kFileError = 4 };
int exit_code_of(const Comparison& comparison, const std::vector<Limit>& fail, const std::vector<Limit>& warn);

std::string table_of(const Comparison& comparison, const capture::Capture& capture);
std::string csv_of(const Comparison& comparison, const capture::Capture& capture);
std::string json_of(const Comparison& comparison, const capture::Capture& capture);

}  // namespace likeness::olat_compare
