#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/exposure/overlay.h"
#include "render/exposure/pick.h"
#include "render/scene/scene.h"

namespace likeness::expose {

// The command line of `likeness expose`, as it was written.
struct Request {
  std::vector<std::string> inputs;
  std::string mode, patch, zone, mask, layer, camera;
  std::optional<double> ev, percentile, floor;
  double most_clipped = 1, most_crushed = 5;  // [%]
  std::string view, display, config;
  std::optional<double> shutter, aperture, iso;
  std::string overlay = "wedge", out, page;
  bool json = false, lists = false;
};

// The same, checked.
struct Options {
  std::optional<exposure::Mode> mode;  // nothing: `ev` is given
  double ev = 0;
  std::optional<exposure::Patch> patch;
  std::optional<double> zone;  // of patch and percentile; nothing: their own
  double percentile = 0.99;
  exposure::Limits limits;
  std::optional<double> floor;
  exposure::Overlay overlay = exposure::Overlay::kWedge;
  scene::View view;  // what is given of it; ev is not
};

// It has an answer for every light, needs no limits, and is the same under every view, so that pictures stay comparable.
inline constexpr exposure::Mode kDefaultMode = exposure::Mode::kAverage;

// Throws files::UsageError, one line: option, value, what is allowed.
Options options_of(const Request& request);

// The zone that a mode puts its light in.
double zone_of(exposure::Mode mode, const Options& options);

}  // namespace likeness::expose
