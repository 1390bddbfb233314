#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "render/expose/request.h"
#include "render/expose/series.h"
#include "render/exposure/measure.h"

namespace likeness::expose {

// One way to expose the series, and what it would do.
struct Alternative {
  std::string name, text;  // of the mode, or "as it is" and "by hand"
  double ev = 0;
  exposure::Shares shares;
  bool is_over_limits = false;  // of `linear`: no exposure keeps to the limits
  bool is_chosen = false;
};

struct Exposed {
  std::string name;
  std::size_t frames = 0;
  int width = 0, height = 0;  // of the first frame
  scene::View view;           // with the chosen EV
  exposure::Curve curve;
  exposure::Limits limits;
  exposure::Histogram histogram;
  std::vector<Alternative> alternatives;
  std::optional<exposure::PatchLight> patch;  // of the first frame
  Taken taken;                                // the same for all frames, or else empty
  bool is_dark = false;                       // no pixel has light: EV is 0 unless it is given by hand
  Shot first;

  const Alternative& chosen() const;
  std::optional<double> ev100() const { return taken.ev100(); }  // as it was taken
};

// Reads every frame once; interrupted, throws files::Interrupted. Throws files::UsageError and files::InputError.
Exposed run_expose(const Series& series, const Options& options, const Taken& given);

}  // namespace likeness::expose
