#include "render/expose/expose.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/files/progress.h"
#include "render/view/view_list.h"

namespace likeness::expose {
namespace {

using exposure::Mode;
using files::UsageError;

exposure::PatchLight light_of(const exposure::Patch& patch, const Frame& frame, const Shot& shot) {
  if (patch.width > shot.light.width - patch.x || patch.height > shot.light.height - patch.y)
    throw UsageError("--patch: " + std::to_string(patch.width) + " x " + std::to_string(patch.height) + " pixels at " +
                     std::to_string(patch.x) + ", " + std::to_string(patch.y) + " do not lie in " + frame.name + ", " +
                     std::to_string(shot.light.width) + " x " + std::to_string(shot.light.height));
  return exposure::light_of_patch(shot.light, patch);
}

std::optional<exposure::Pick> picked(Mode mode, const exposure::Meter& meter, const Options& options,
                                     const std::optional<exposure::PatchLight>& patch) {
  switch (mode) {
    case Mode::kLinear:
      return exposure::pick_linear(meter, options.limits);
    case Mode::kAverage:
      return exposure::pick_average(meter);
    case Mode::kPercentile:
      return exposure::pick_percentile(meter, options.percentile, zone_of(mode, options));
    case Mode::kPatch:
    case Mode::kCard:
      break;
  }
  if (!patch || !(patch->luminance > 0)) return std::nullopt;
  const double ev = exposure::ev_for(patch->luminance, zone_of(mode, options));
  return exposure::Pick{std::clamp(ev, -exposure::kMostStops, exposure::kMostStops), false};
}

std::vector<Alternative> alternatives_of(const exposure::Meter& meter, const Options& options,
                                         const std::optional<exposure::PatchLight>& patch) {
  std::vector<Alternative> out;
  for (const exposure::ModeRow& row : exposure::kModes) {
    const auto pick = picked(row.mode, meter, options, patch);
    if (!pick) continue;
    out.push_back({std::string(row.name), std::string(row.text), pick->ev, meter.shares(pick->ev), pick->is_over_limits,
                   options.mode == row.mode});
  }
  out.push_back({"as it is", "no exposure: the light of the file", 0, meter.shares(0), false, false});
  if (!options.mode) out.push_back({"by hand", "--ev", options.ev, meter.shares(options.ev), false, true});
  return out;
}

}  // namespace

const Alternative& Exposed::chosen() const {
  return *std::find_if(alternatives.begin(), alternatives.end(), [](const Alternative& a) { return a.is_chosen; });
}

Exposed run_expose(const Series& series, const Options& options, const Taken& given) {
  Exposed out;
  out.name = series.name;
  out.frames = series.frames.size();
  out.limits = options.limits;
  const bool is_said = !options.view.name.empty() || !options.view.display.empty() || !options.view.config.empty();
  out.view = view::with_defaults(is_said ? options.view : series.view);
  out.curve = exposure::curve_of(out.view);

  files::Progress progress;
  for (std::size_t i = 0; i < series.frames.size(); ++i) {
    if (files::interrupted()) throw files::Interrupted{};
    progress.tell(series.frames[i].name, static_cast<double>(i) / static_cast<double>(series.frames.size()));
    Shot shot = series.frames[i].read();
    out.histogram.add(shot.light, shot.weights, shot.floor);
    if (given.f_number) shot.taken.f_number = given.f_number;
    if (given.seconds) shot.taken.seconds = given.seconds;
    if (given.iso) shot.taken.iso = given.iso;
    if (i > 0) {
      if (!(shot.taken == out.taken)) out.taken = {};
      continue;
    }
    if (options.patch) out.patch = light_of(*options.patch, series.frames[0], shot);
    out.taken = shot.taken;
    out.width = shot.light.width, out.height = shot.light.height;
    out.first = std::move(shot);
  }

  if (out.patch && options.mode && exposure::kModes[static_cast<std::size_t>(*options.mode)].needs_patch &&
      !(out.patch->luminance > 0))
    throw files::InputError(series.frames[0].name + ": the patch has no light, so no exposure puts it in a zone");
  const exposure::Meter meter(out.histogram, out.curve);
  out.alternatives = alternatives_of(meter, options, out.patch);
  out.is_dark = meter.luminance().is_empty();
  const bool has_choice =
      std::any_of(out.alternatives.begin(), out.alternatives.end(), [](const Alternative& a) { return a.is_chosen; });
  if (!has_choice) out.alternatives.front().is_chosen = true;  // all is dark: "as it is" alone is there
  out.view.ev = out.chosen().ev;
  return out;
}

}  // namespace likeness::expose
