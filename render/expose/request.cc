#include "render/expose/request.h"

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>

#include "brdf/lighting/zone.h"
#include "render/exposure/text.h"
#include "render/files/files.h"

namespace likeness::expose {
namespace {

using exposure::Mode;
using files::UsageError;

exposure::Mode mode_named(const std::string& name) {
  std::string list;
  std::array<std::string_view, exposure::kModes.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (exposure::kModes[i].name == name) return exposure::kModes[i].mode;
    names[i] = exposure::kModes[i].name;
    list += (i == 0 ? "" : ", ") + std::string(names[i]);
  }
  const std::string near = files::nearest_name(name, names.data(), names.size());
  throw UsageError("--mode " + files::in_quotes(name) + " is not one of " + list +
                   (near.empty() ? "" : "; did you mean " + near + "?"));
}

// "X,Y,WIDTH,HEIGHT"
exposure::Patch patch_of(const std::string& text) {
  std::array<int, 4> n{};
  std::string_view rest = text;
  bool is_whole = true;
  for (std::size_t i = 0; i < n.size(); ++i) {
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), n[i]);
    is_whole = is_whole && error == std::errc{};
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    if (i + 1 < n.size()) {
      is_whole = is_whole && rest.starts_with(',');
      rest.remove_prefix(rest.empty() ? 0 : 1);
    }
  }
  if (!is_whole || !rest.empty() || n[0] < 0 || n[1] < 0 || n[2] < 1 || n[3] < 1)
    throw UsageError("--patch " + files::in_quotes(text) +
                     " is no patch; expected X,Y,WIDTH,HEIGHT in pixels from the top left, as 120,80,16,16");
  return {n[0], n[1], n[2], n[3]};
}

double within(const char* option, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return value;
  throw UsageError(std::string(option) + " " + files::number_text(value) + " is outside [" + files::number_text(low) +
                   ", " + files::number_text(high) + "]" + unit);
}

void check_of_camera(const char* option, const std::optional<double>& value) {
  if (value && !(*value > 0 && *value <= 1e9))
    throw UsageError(std::string(option) + " " + files::number_text(*value) + " is no number above 0");
}

void check_ending(const char* option, const std::string& name, std::string_view ending) {
  if (!name.empty() && std::filesystem::path(name).extension() != ending)
    throw UsageError(std::string(option) + " " + files::in_quotes(name) + " does not end with " + std::string(ending));
}

}  // namespace

Options options_of(const Request& r) {
  Options out;
  if (r.ev && !r.mode.empty()) throw UsageError("--ev and --mode exclude each other; give one of them");
  if (r.ev) out.ev = within("--ev", *r.ev, -exposure::kMostStops, exposure::kMostStops, " (stops)");
  else out.mode = r.mode.empty() ? kDefaultMode : mode_named(r.mode);
  if (!r.patch.empty()) out.patch = patch_of(r.patch);
  if (out.mode && exposure::kModes[static_cast<std::size_t>(*out.mode)].needs_patch && !out.patch)
    throw UsageError("--mode " + r.mode + " needs --patch X,Y,WIDTH,HEIGHT: where in the picture it is");
  if (!r.zone.empty()) {
    if (out.mode != Mode::kPatch && out.mode != Mode::kPercentile)
      throw UsageError("--zone is of --mode patch and percentile: where their light is to be");
    out.zone = exposure::zone_named(r.zone);
    if (*out.zone < 0)
      throw UsageError("--zone " + files::in_quotes(r.zone) + " is no zone; expected 0, I, II, ... XVI, or a number");
  }
  if (r.percentile) {
    if (out.mode != Mode::kPercentile) throw UsageError("--percentile is of --mode percentile");
    out.percentile = within("--percentile", *r.percentile, 0, 100, " %") / 100;
  }
  out.limits.clipped = within("--most-clipped", r.most_clipped, 0, 100, " %") / 100;
  out.limits.crushed = within("--most-crushed", r.most_crushed, 0, 100, " %") / 100;
  if (r.floor) out.floor = within("--floor", *r.floor, 0, 1e30, " (light)");
  check_of_camera("--shutter", r.shutter);
  check_of_camera("--aperture", r.aperture);
  check_of_camera("--iso", r.iso);
  out.overlay = exposure::overlay_named("--overlay", r.overlay);
  if (r.inputs.size() == 1 && !std::filesystem::is_directory(r.inputs[0])) check_ending("--out", r.out, ".png");
  check_ending("--page", r.page, ".html");
  out.view = {0, r.view, r.display, r.config};
  return out;
}

double zone_of(exposure::Mode mode, const Options& options) {
  const bool is_asked = mode == options.mode && options.zone.has_value();
  if (is_asked) return *options.zone;
  return mode == Mode::kPercentile ? exposure::white_zone() : brdf::Zones::kGreyZone;
}

}  // namespace likeness::expose
