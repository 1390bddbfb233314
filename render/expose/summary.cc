#include "render/expose/summary.h"

#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "brdf/lighting/zone.h"
#include "render/exposure/text.h"
#include "render/view/view_list.h"

namespace likeness::expose {
namespace {

using Json = nlohmann::ordered_json;

std::string formatted(const char* format, double value) {
  char out[48];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

std::string shares_text(const exposure::Shares& s) {
  return "toe " + percent_text(s.toe) + " %, linear " + percent_text(s.linear) + " %, shoulder " +
         percent_text(s.shoulder) + " %; clipped " + percent_text(s.clipped) + " %, crushed " +
         percent_text(s.crushed) + " %";
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json shares_json(const exposure::Shares& s) {
  return {{"zones", s.zones},     {"toe", s.toe},         {"linear", s.linear}, {"shoulder", s.shoulder},
          {"clipped", s.clipped}, {"crushed", s.crushed}, {"black", s.black}};
}

}  // namespace

std::string stops_text(double ev) { return std::abs(ev) < 0.005 ? "0" : formatted("%+.2f", ev); }

std::string percent_text(double share) {
  const double percent = 100 * share;
  if (percent == 0) return "0";
  if (percent < 0.01) return "<0.01";
  if (percent < 1) return formatted("%.2f", percent);
  return percent < 99.95 ? formatted("%.1f", percent) : percent < 100 ? ">99.9" : "100";
}

std::string reason_text(const Exposed& e) {
  if (e.is_dark) return "No pixel has light, so there is nothing to expose for.";
  const Alternative& chosen = e.chosen();
  std::string out = chosen.name + ": " + chosen.text + ".";
  if (chosen.name != "linear") return out;
  const std::string limits =
      "at most " + percent_text(e.limits.clipped) + " % clipped and " + percent_text(e.limits.crushed) + " % crushed";
  return out + (chosen.is_over_limits
                    ? " No exposure keeps to the limits (" + limits + "): this one exceeds them least."
                    : " The limits (" + limits + ") are kept.");
}

std::string oddities_text(const Exposed& e) {
  const exposure::Counts& c = e.histogram.counts();
  std::string out;
  const auto line = [&](std::uint64_t count, const char* one, const char* many) {
    if (count > 0) out += std::to_string(count) + (count == 1 ? one : many) + "\n";
  };
  line(c.masked, " pixel is masked", " pixels are masked");
  line(c.not_number, " pixel is not a number, and left out", " pixels are not numbers, and left out");
  line(c.infinite, " pixel is infinite", " pixels are infinite");
  line(c.negative, " pixel has a channel below 0", " pixels have a channel below 0");
  line(c.denormal, " pixel has light below 1.2e-38", " pixels have light below 1.2e-38");
  if (e.histogram.black_weight() > 0)
    out += percent_text(static_cast<double>(e.histogram.black_weight()) / static_cast<double>(e.histogram.weight())) +
           " % of what is counted has no light" + (e.first.floor > 0 ? " above the noise" : "") +
           ": zone 0 and toe, but not crushed\n";
  return out;
}

std::string summary_text(const Exposed& e) {
  const Alternative& chosen = e.chosen();
  std::string out = e.name + "  " + (e.frames > 1 ? std::to_string(e.frames) + " pictures, the first " : "") +
                    std::to_string(e.width) + " x " + std::to_string(e.height) + "\n";
  out += "view " + view::origin_text(e.view) + ": toe below " + formatted("%.3g", e.curve.toe_end) +
         ", shoulder above " + formatted("%.3g", e.curve.shoulder_start) + ", full from " +
         formatted("%.3g", e.curve.clipped_from) + ", black below " + formatted("%.2g", e.curve.crushed_below) + "\n";
  out += oddities_text(e);
  out += "\nEV " + stops_text(chosen.ev) + "  " + reason_text(e) + "\n";
  if (const auto ev100 = e.ev100())
    out += "EV100 " + formatted("%.2f", *ev100) + " as taken; a camera set to " +
           formatted("%.2f", *ev100 - chosen.ev) + " would have had it right\n";
  if (e.patch)
    out += "patch  luminance " + formatted("%.4g", e.patch->luminance) + ", even to " +
           formatted("%.2f", e.patch->spread_stops) + " stops; zone " +
           formatted("%.2f", brdf::zone_of<double>(e.patch->luminance * std::exp2(chosen.ev), brdf::Zones::kMiddleGrey,
                                                   brdf::Zones::kGreyZone)) +
           " at this EV\n";
  out += shares_text(chosen.shares) + "\n\n";

  std::string zones = "zone   ", stops = "EV     ", shares = "share %";
  for (int i = 0; i < brdf::Zones::kCount; ++i) {
    const int ev = i - static_cast<int>(brdf::Zones::kGreyZone);
    zones += padded(std::string(exposure::zone_numeral(i)), 6);
    stops += padded((ev > 0 ? "+" : "") + std::to_string(ev), 6);
    shares += padded(percent_text(chosen.shares.zones[static_cast<std::size_t>(i)]), 6);
  }
  out += zones + "\n" + stops + "\n" + shares + "\n\n";
  for (const Alternative& a : e.alternatives) {
    std::string name = (a.is_chosen ? "* " : "  ") + a.name;
    name.resize(14, ' ');
    out += name + padded(stops_text(a.ev), 7) + "  " + shares_text(a.shares) +
           (a.is_over_limits ? "  (limits cannot be kept)" : "") + "\n";
  }
  return out;
}

std::string summary_json(const Exposed& e) {
  const Alternative& chosen = e.chosen();
  Json out;
  out["name"] = e.name;
  out["pictures"] = e.frames;
  out["size"] = {e.width, e.height};
  out["mode"] = chosen.name;
  out["ev"] = chosen.ev;
  out["reason"] = reason_text(e);
  out["limits"] = {{"clipped", e.limits.clipped}, {"crushed", e.limits.crushed}, {"kept", !chosen.is_over_limits}};
  const auto ev100 = e.ev100();
  out["ev100"] = {{"taken", ev100 ? Json(*ev100) : Json(nullptr)},
                  {"picked", ev100 ? Json(*ev100 - chosen.ev) : Json(nullptr)}};
  out["view"] = {{"name", e.view.name}, {"display", e.view.display}, {"text", view::origin_text(e.view)}};
  out["curve"] = {{"toe_end", e.curve.toe_end},
                  {"shoulder_start", number_or_null(e.curve.shoulder_start)},
                  {"clipped_from", number_or_null(e.curve.clipped_from)},
                  {"crushed_below", number_or_null(e.curve.crushed_below)}};
  const exposure::Counts& c = e.histogram.counts();
  out["pixels"] = {{"all", c.all},           {"masked", c.masked},     {"not_number", c.not_number},
                   {"infinite", c.infinite}, {"negative", c.negative}, {"denormal", c.denormal}};
  out["shares"] = shares_json(chosen.shares);
  if (e.patch)
    out["patch"] = {{"luminance", e.patch->luminance},
                    {"rgb", e.patch->rgb},
                    {"spread_stops", e.patch->spread_stops},
                    {"pixels", e.patch->pixels}};
  for (const Alternative& a : e.alternatives)
    out["alternatives"].push_back(
        {{"mode", a.name}, {"ev", a.ev}, {"over_limits", a.is_over_limits}, {"shares", shares_json(a.shares)}});
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace likeness::expose
