#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "render/image/flip.h"
#include "render/image/picture.h"

// How far a photo and a render of the same view and the same light are apart: as a map, and as a few numbers of the map
// over the pixels that count. What each computes of one value is in olat/metric/formulas.h.
namespace likeness::metric {

enum class Metric : unsigned char { kStops, kSigned, kAbsolute, kSmape, kDeltaE, kFlip, kHdrFlip };

// What is compared: linear light, or what a display shows of both.
enum class Of : unsigned char { kLight, kDisplay };

struct MetricRow {
  std::string_view id, unit, text;
  Of of;
  int channels;    // of the map
  bool is_signed;  // worse is further from 0 on either side; otherwise worse is higher. 0 is equal in all of them
};

// In the order of Metric. The command line, --help, the pages and the tests are made from it.
inline constexpr std::array kMetrics{
    MetricRow{"stops", "stop", "log2((photo + n) / (render + n)), n the noise floor; light below 0 counts as 0",
              Of::kLight, 3, true},
    MetricRow{"signed", "light", "photo - render", Of::kLight, 3, true},
    MetricRow{"absolute", "light", "|photo - render|", Of::kLight, 3, false},
    MetricRow{"smape", "1", "2 |photo - render| / (|photo| + |render| + 2 n), 0 to 2", Of::kLight, 3, false},
    MetricRow{"delta_e", "Delta E 2000", "color difference as an eye sees it: 1 can just be told", Of::kDisplay, 1,
              false},
    MetricRow{"flip", "1", "LDR-FLIP: what is seen when the two alternate, 0 to 1", Of::kDisplay, 1, false},
    MetricRow{"hdr_flip", "1", "HDR-FLIP: the largest FLIP over the capture's exposures, 0 to 1", Of::kLight, 1, false},
};
constexpr const MetricRow& row_of(Metric metric) { return kMetrics[static_cast<std::size_t>(metric)]; }

// Throws files::UsageError with the nearest name.
Metric metric_of(std::string_view id);

// What is compared. All pictures have one size, else std::invalid_argument.
struct Pair {
  const image::Picture* photo = nullptr;  // linear Rec. 709, the same unit
  const image::Picture* render = nullptr;
  const image::DisplayPicture* shown_photo = nullptr;  // both by one exposure and one view; for metrics of the display
  const image::DisplayPicture* shown_render = nullptr;
  std::span<const float> weight{};  // of each pixel: coverage times cosine times what else; empty: 1. Not below 0
  std::array<float, 3> noise_floor{1e-4f, 1e-4f, 1e-4f};  // raised to kLeastNoise
  image::Exposures exposures{-4, 3};                      // of HDR-FLIP, the same for a whole capture
  image::FlipOptions flip{};
};

// Row by row from the top left, channels interleaved. NaN: the light of the photo or of the render is not finite there.
struct Map {
  int width = 0, height = 0, channels = 1;
  std::vector<float> values;
};

// FLIP filters: so that what is not compared (weight 0, or not finite) does not leak in, both pictures are black there.
// Rows are shared among TBB's threads; the result does not depend on their number.
Map map_of(Metric metric, const Pair& pair);

// Of the values, each with its pixel's weight; what is NaN is left out and counted. A quantile is the smallest value that
// reaches its share of the weight (nearest rank).
struct Summary {
  double mean = 0, median = 0;  // signed, if the metric is
  double p95 = 0, rms = 0;      // of magnitudes
  double largest = 0;           // magnitude
  std::size_t pixels = 0;       // of weight above 0 that count
  std::size_t not_finite = 0;   // pixels of weight above 0 that do not
};
Summary summary_of(const Map& map, std::span<const float> weight);

// The numbers of a Summary by their names, for tables and thresholds.
struct StatisticRow {
  std::string_view id, text;
  double Summary::* value;
};
inline constexpr std::array kStatistics{
    StatisticRow{"mean", "weighted mean; signed, if the metric is", &Summary::mean},
    StatisticRow{"median", "half of the weight is at most this; signed, if the metric is", &Summary::median},
    StatisticRow{"p95", "95 % of the weight is at most this, in magnitude", &Summary::p95},
    StatisticRow{"rms", "root of the mean square", &Summary::rms},
    StatisticRow{"largest", "largest magnitude", &Summary::largest},
};

}  // namespace likeness::metric
