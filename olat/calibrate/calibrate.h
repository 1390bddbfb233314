#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "olat/calibrate/chart.h"
#include "render/capture/capture.h"

// Measures what a capture's files leave open, and writes it into them.
namespace likeness::olat_calibrate {

enum class GainOf : unsigned char { kNothing, kLight, kChannel };

struct Options {
  GainOf gain = GainOf::kNothing;
  // Gains less their median, so that the capture keeps its unit light; or as they are.
  bool is_absolute = false;
  std::string variant;                       // renders of gains; empty: the first
  const capture::Capture* grey = nullptr;    // gains from photos of a grey or white card under the same lights instead
  const capture::Capture* chrome = nullptr;  // directions from photos of a mirror ball under the same lights
  bool noise = false;                        // the noise floor of each camera
  std::string camera;                        // of chart and flat field; empty: all
  std::string chart, reference;              // a photo of a chart, and its values
  std::optional<Corners> corners;            // of the chart; without them it is looked for
  std::string flat;                          // a photo of an evenly lit, even surface
  std::function<bool(std::string_view what, double share)> keep_going;
};

struct Change {
  std::string file, id;  // lights.json or cameras.json; of the row
  std::string what, before, after;
};

struct Result {
  capture::Capture capture;  // with the changes
  std::vector<Change> changes;
  std::vector<std::string> notes;  // what could not be measured, and how lights were matched
  std::optional<ChartFit> chart;
  std::string chart_space;             // of the reference
  std::optional<image::Picture> flat;  // to be written as a layer: its mean is 1
};

// Throws files::UsageError: an id or a set of lights that does not match; files::InputError: a file that cannot be used.
// Interrupted by keep_going: files::Interrupted, nothing is changed.
Result run_calibrate(const capture::Capture& capture, const Options& options);

// The result into a new folder (photos and layers then have absolute paths, and renders stay behind), or, if `folder` is
// empty, into the capture's own, where each file that changes is kept as NAME.1.json, .2.json, ... Returns the lines that say
// what was written.
std::vector<std::string> write_result(const Result& result, const std::string& folder);

std::string text_of(const Result& result);
std::string json_of(const Result& result);

}  // namespace likeness::olat_calibrate
