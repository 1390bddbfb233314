#include "fit/report/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>

#include "render/image/tone_curve.h"
#include "render/page/html.h"

namespace likeness::fit {

using page::element;
using page::escape;
using page::fixed;
using page::number;
using page::plain;
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

enum class Better { kLower, kHigher };

struct MetricRow {
  std::string name, nearest, definition;
  Better better = Better::kLower;
  std::function<double(const Candidate&)> rank;       // what is compared; NaN takes no part
  std::function<std::string(const Candidate&)> cell;  // what is shown
};

std::string share(std::size_t used, std::size_t all) {
  if (all == 0) return "no samples";
  return std::to_string(used) + " of " + std::to_string(all) + " samples used (" +
         fixed(100.0 * static_cast<double>(used) / static_cast<double>(all), 1) + " %)";
}

std::string three(const measured::Rgb& c, int decimals) {
  return fixed(c.r, decimals) + ", " + fixed(c.g, decimals) + ", " + fixed(c.b, decimals);
}

std::string signed_fixed(double x, int decimals) { return (x >= 0 ? "+" : "") + fixed(x, decimals); }

double albedo_distance(const Metrics& m) {
  const double r = m.albedo_model.r - m.albedo_reference.r, g = m.albedo_model.g - m.albedo_reference.g,
               b = m.albedo_model.b - m.albedo_reference.b;
  return std::sqrt((r * r + g * g + b * b) / 3);
}

std::vector<MetricRow> metric_rows(const Result& result) {
  const Metrics& fitted = result.best.metrics;
  const std::string cut = "θi, θo ≤ " + plain(result.options.cut_deg) + "°";
  const std::string slice =
      "standard slice, 90 × 90, φd = 90°, " + cut + "; " + share(fitted.slice_samples, fitted.slice_grid);
  const std::string table = "all samples of the file, weighted by solid angle, " + cut + "; " +
                            share(fitted.table_samples, fitted.table_stored);
  const auto metric = [](double Metrics::* member, int decimals) {
    return std::pair{[member](const Candidate& c) { return c.metrics.*member; },
                     [member, decimals](const Candidate& c) { return fixed(c.metrics.*member, decimals); }};
  };
  std::vector<MetricRow> rows;
  const auto add = [&](std::string name, std::string definition, Better better, auto functions) {
    rows.push_back({std::move(name), better == Better::kLower ? "lower is nearer" : "higher is nearer",
                    std::move(definition), better, functions.first, functions.second});
  };
  add("Slice error [%]",
      "100 × RMS of clamp01 f − clamp01 g over RGB, f the measurement and g the model in 1/sr, both at "
      "the directions of the stored value; " +
          slice,
      Better::kLower, metric(&Metrics::slice_error_pct, 2));
  add("Slice log RMS", "RMS of ln(1 + f cos θi) − ln(1 + g cos θi); " + slice, Better::kLower,
      metric(&Metrics::slice_log_rms, 4));
  if (result.format == measured::Format::kMerl) {
    const std::string at_grid =
        "as above, with the model at the grid's directions although a table's value holds at the centre of the nearest "
        "bin: the reading of published numbers";
    add("Slice error at grid [%]", at_grid, Better::kLower, metric(&Metrics::slice_error_pct_at_grid, 2));
    add("Slice log RMS at grid", at_grid, Better::kLower, metric(&Metrics::slice_log_rms_at_grid, 4));
  }
  add("Whole-table log RMS", "the same difference over " + table, Better::kLower, metric(&Metrics::log_rms_3d, 4));
  rows.push_back({"Albedo error", "nearest to 0 is best",
                  "bihemispherical reflectance within the cut, model − measured; the measured one is " +
                      three(fitted.albedo_reference, 3) + "; " + table,
                  Better::kLower, [](const Candidate& c) { return albedo_distance(c.metrics); },
                  [](const Candidate& c) {
                    const measured::Rgb &a = c.metrics.albedo_model, &b = c.metrics.albedo_reference;
                    return "R " + signed_fixed(a.r - b.r, 3) + "\nG " + signed_fixed(a.g - b.g, 3) + "\nB " +
                           signed_fixed(a.b - b.b, 3);
                  }});
  const std::string spheres = "two spheres lit at 30° and 120° from the camera, displayed in 8-bit sRGB";
  add("Sphere PSNR [dB]", "peak signal-to-noise ratio; " + spheres, Better::kHigher, metric(&Metrics::sphere_psnr, 1));
  add("Sphere SSIM", "structural similarity, Wang 2004; " + spheres, Better::kHigher, metric(&Metrics::sphere_ssim, 4));
  const bool log_loss = result.options.loss == Loss::kLog, on_slice = result.options.on == Domain::kSlice;
  rows.push_back({"Fitted loss", "lower is nearer",
                  std::string("what the fit minimises (") + (log_loss ? "log" : "cube-root") + " difference on the " +
                      (on_slice ? "slice" : "whole table") + ", " + cut + "); comparable between the columns",
                  Better::kLower, [](const Candidate& c) { return c.loss; },
                  [](const Candidate& c) { return number(c.loss, 4); }});
  rows.push_back({"CPU time of the fit [s]", "", "all starts together; a hand set needs none", Better::kLower,
                  [](const Candidate&) { return kNoNumber; },
                  [](const Candidate& c) { return c.estimates.empty() ? "-" : fixed(c.cpu_seconds, 2); }});
  return rows;
}

// One parameter of a model: its row, and its channels (1 or 3).
struct ParameterValue {
  const brdf::Parameter* row;
  std::vector<double> channels;
};

std::vector<ParameterValue> parameter_values(const brdf::AnyBrdf& any) {
  std::vector<ParameterValue> out;
  std::visit(
      [&](const auto& model) {
        using Model = std::remove_cvref_t<decltype(model)>;
        std::size_t at = 0;
        brdf::for_each_parameter(model, [&]<class V>(const brdf::Parameter&, const V& value) {
          const brdf::Parameter* const row = &Model::kParameters[at++];
          if constexpr (std::is_same_v<V, brdf::Rgb<double>>) out.push_back({row, {value.r, value.g, value.b}});
          else out.push_back({row, {value}});
        });
      },
      any);
  return out;
}

const Estimate* estimate_of(const Candidate& candidate, std::string_view name, int channel) {
  for (const Estimate& estimate : candidate.estimates)
    if (estimate.name == name && estimate.channel == channel) return &estimate;
  return nullptr;
}

std::string swatch(const std::vector<double>& rgb) {
  std::array<char, 8> hex{};
  std::snprintf(hex.data(), hex.size(), "#%02x%02x%02x", image::srgb_encode8(static_cast<float>(rgb[0])),
                image::srgb_encode8(static_cast<float>(rgb[1])), image::srgb_encode8(static_cast<float>(rgb[2])));
  return std::string("<span class=\"swatch\" style=\"background:") + hex.data() + "\"></span><code>" + hex.data() +
         "</code> <small>sRGB</small><br>";
}

std::string badge(std::string_view text) { return "<span class=\"badge warn\">" + escape(text) + "</span> "; }

struct ParameterCells {
  std::string value, sigma, notes;
  bool fitted = false;
};

ParameterCells cells_of(const Candidate& candidate, const ParameterValue& parameter) {
  static constexpr std::array<std::string_view, 3> kChannels{"R ", "G ", "B "};
  const brdf::Parameter& row = *parameter.row;
  const bool color = parameter.channels.size() == 3;
  ParameterCells out;
  if (color) out.value = swatch(parameter.channels);
  std::string last_note;
  for (std::size_t c = 0; c < parameter.channels.size(); ++c) {
    const Estimate* const estimate = estimate_of(candidate, row.name, color ? static_cast<int>(c) : -1);
    const std::string_view channel = color ? kChannels[c] : std::string_view();
    out.value += (c > 0 ? "<br>" : "") + std::string(channel) + number(parameter.channels[c], 4);
    if (color && c == 0) out.sigma = "<br>";
    const bool free = estimate && estimate->fitted;
    out.sigma +=
        (c > 0 ? "<br>" : "") +
        (free && estimate->matters && std::isfinite(estimate->sigma) ? "± " + number(estimate->sigma, 2) : "-");
    out.fitted = out.fitted || free;
    std::string note;
    if (free && !estimate->matters)
      note = badge("does not matter") + "because " +
             escape(estimate->why.empty() ? "the data do not depend on it" : estimate->why);
    else if (free && estimate->at_bound)
      note = badge(parameter.channels[c] - row.range.low <= row.range.high - parameter.channels[c] ? "at lower bound"
                                                                                                   : "at upper bound");
    if (note.empty()) continue;
    if (note == last_note) continue;  // said once for all channels
    out.notes += (out.notes.empty() ? "" : "<br>") +
                 (note.find("does not") == std::string::npos ? std::string(channel) : "") + note;
    if (note.find("does not") != std::string::npos) last_note = note;
  }
  if (!candidate.estimates.empty() && !out.fitted) {
    const Estimate* const estimate = estimate_of(candidate, row.name, color ? 0 : -1);
    out.notes =
        estimate && !estimate->why.empty() ? "not fitted: " + escape(estimate->why) : "left at its default, not fitted";
  }
  return out;
}

}  // namespace

std::vector<const Candidate*> candidates_of(const Result& result) {
  std::vector<const Candidate*> out{&result.best};
  for (const Candidate& baseline : result.baselines) out.push_back(&baseline);
  if (result.hand_set) out.push_back(&*result.hand_set);
  if (result.hand_set_disney) out.push_back(&*result.hand_set_disney);
  return out;
}

std::string metrics_table(const Result& result) {
  const std::vector<const Candidate*> candidates = candidates_of(result);
  std::string out =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Metrics\"><table "
      "class=\"metrics\">\n<thead><tr><th "
      "scope=\"col\">Metric</th>";
  for (const Candidate* candidate : candidates)
    out += "<th scope=\"col\">" + escape(candidate->label) +
           (candidate == &result.best ? "<br><small>this fit</small>" : "") + "</th>";
  out += "</tr></thead>\n<tbody>\n";
  const std::vector<MetricRow> rows = metric_rows(result);
  for (const MetricRow& row : rows) {
    const double sign = row.better == Better::kLower ? 1 : -1;
    double best = std::numeric_limits<double>::infinity();
    bool any = false;
    for (const Candidate* candidate : candidates)
      if (const double rank = row.rank(*candidate); !std::isnan(rank)) best = std::min(best, sign * rank), any = true;
    out += "<tr><th scope=\"row\">" + escape(row.name) + "<small>" + escape(row.nearest) + "</small></th>";
    for (const Candidate* candidate : candidates) {
      const bool is_best = any && candidates.size() > 1 && sign * row.rank(*candidate) == best;
      out += std::string("<td class=\"n") + (is_best ? " best" : "") + "\">" + escape(row.cell(*candidate)) +
             (is_best ? "<br><small>✓ best</small>" : "") + "</td>";
    }
    out += "</tr>\n";
  }
  out += "</tbody></table></div>\n<h3>What each metric is</h3>\n<dl>\n";
  for (const MetricRow& row : rows) out += element("dt", row.name) + element("dd", row.definition) + "\n";
  return out + "</dl>\n";
}

std::string parameters_table(const Candidate& candidate, const std::string& caption) {
  const bool fitted = !candidate.estimates.empty();
  std::string out = "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" + escape(caption) +
                    "\"><table>\n<thead><tr><th scope=\"col\">Parameter</th><th scope=\"col\">Value</th>" +
                    (fitted ? "<th scope=\"col\">± 1 σ</th>" : "") +
                    "<th scope=\"col\">Allowed</th><th scope=\"col\">Unit</th><th scope=\"col\">Tier</th>" +
                    (fitted ? "<th scope=\"col\">To know</th>" : "") + "</tr></thead>\n<tbody>\n";
  for (const ParameterValue& parameter : parameter_values(candidate.brdf)) {
    const brdf::Parameter& row = *parameter.row;
    const ParameterCells cells = cells_of(candidate, parameter);
    out += std::string("<tr") + (fitted && !cells.fitted ? " class=\"fixed\"" : "") + "><th scope=\"row\"><code>" +
           escape(row.name) + "</code><small>" + escape(row.text) + "</small></th><td class=\"n\">" + cells.value +
           "</td>";
    if (fitted) out += "<td class=\"n\">" + cells.sigma + "</td>";
    out += "<td class=\"n\">" + plain(row.range.low) + " to " + plain(row.range.high) + "</td><td>" +
           (row.unit == "1" ? "none" : escape(row.unit)) + "</td><td>" +
           escape(brdf::kTierNames[static_cast<std::size_t>(row.tier)]) + "</td>";
    if (fitted) out += "<td>" + cells.notes + "</td>";
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace likeness::fit
