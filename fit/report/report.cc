#include "fit/report/report.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "fit/report/plots.h"
#include "fit/report/spheres.h"
#include "fit/report/tables.h"
#include "fit/slice/slice.h"
#include "render/image/write.h"
#include "render/page/html.h"

namespace likeness::fit {

using page::element;
using page::escape;
using page::fixed;
using page::page_foot;
using page::page_head;
using page::plain;
using page::png_data_url;
namespace {

// With a space that does not break before the sign.
std::string percent(double x) { return fixed(x, x < 0.1 ? 3 : x < 10 ? 1 : 0) + "\u00a0%"; }

std::string as_shell_word(const std::string& text) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._/+-=:,@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

std::string verdict(const Result& result) {
  const std::vector<const Candidate*> all = candidates_of(result);
  std::string out = escape(result.best.label) + ", comes within <strong>" +
                    percent(result.best.metrics.slice_error_pct) + "</strong> of the measured slice";
  for (std::size_t i = 1; i < all.size(); ++i)
    out +=
        (i == 1 ? ". For comparison: " : "; ") + escape(all[i]->label) + " " + percent(all[i]->metrics.slice_error_pct);
  out += ".";
  const Candidate* nearest = all.front();
  for (const Candidate* candidate : all)
    if (candidate->metrics.slice_error_pct < nearest->metrics.slice_error_pct) nearest = candidate;
  constexpr double kWorthSaying = 0.99;  // less than a percent of the error is the tie of two optima
  if (nearest->metrics.slice_error_pct < kWorthSaying * all.front()->metrics.slice_error_pct)
    out += " By this measure <strong>" + escape(nearest->label) +
           "</strong> is nearer; the fit minimises its loss, not this number: see the metrics.";
  return out;
}

std::string valid_share(const measured::Coverage& c) {
  if (c.stored == 0) return "no samples";
  return fixed(100.0 * static_cast<double>(c.valid) / static_cast<double>(c.stored), 1) + " % of " +
         std::to_string(c.stored) + " stored samples are valid";
}

std::string cut_words(const Result& result) { return plain(result.options.cut_deg) + "°"; }

// What the picture rows share.
struct Show {
  double cut_deg, slice_ev, spheres_ev;
  SlicePicture reference;
};

std::string spheres_cell(const SpherePicture& spheres, const Show& show, const std::string& label) {
  std::string out = "<figure class=\"spheres\"><img width=\"480\" height=\"160\" src=\"" +
                    png_data_url(image::png_bytes(spheres_picture(spheres, show.spheres_ev))) + "\" alt=\"" +
                    escape("Three spheres of " + label +
                           ", lit from the camera, from the right at 90 degrees, "
                           "and from behind at 130 degrees.") +
                    "\"><figcaption class=\"angles\">";
  for (const double angle : kSphereLightsDeg) out += "<span>light at " + plain(angle) + "°</span>";
  return out + "</figcaption></figure>";
}

std::string slice_cell(const SlicePicture& slice, const Show& show, const std::string& label) {
  return "<figure>" + slice_figure(slice_picture(slice, show.slice_ev), show.cut_deg, "BRDF slice: " + label) +
         "<figcaption>slice</figcaption></figure>";
}

std::string reference_row(const SpherePicture& spheres, const Show& show) {
  return "<section class=\"row\"><header><h3>Measured</h3><span class=\"quiet\">the reference</span></header>"
         "<div class=\"pictures\">" +
         slice_cell(show.reference, show, "measured") + "<figure>" + regions_figure() +
         "<figcaption>what lies where in every slice</figcaption></figure>" +
         spheres_cell(spheres, show, "the measured material") + "</div></section>\n";
}

std::string candidate_row(const Candidate& candidate, bool is_fit, const Show& show) {
  const SlicePicture slice = slice_of(candidate.brdf);
  const Stops stops = difference_in_stops(show.reference, slice, show.cut_deg);
  return std::string("<section class=\"row") + (is_fit ? " fit" : "") + "\"><header><h3>" + escape(candidate.label) +
         (is_fit ? " (this fit)" : "") + "</h3><span class=\"quiet\">slice error " +
         percent(candidate.metrics.slice_error_pct) + ", slice log RMS " + fixed(candidate.metrics.slice_log_rms, 4) +
         "; half of the slice within " + fixed(median_difference(stops), 2) +
         " stops</span></header><div class=\"pictures\">" + slice_cell(slice, show, candidate.label) + "<figure>" +
         slice_figure(difference_picture(stops), show.cut_deg,
                      "Difference in stops, " + candidate.label + " against measured") +
         "<figcaption>difference from measured</figcaption></figure>" +
         spheres_cell(spheres_of(candidate.brdf), show, candidate.label) + "</div></section>\n";
}

std::string pictures_section(const Result& result, const measured::Material& material) {
  Show show{result.options.cut_deg, 0, 0, slice_of(material)};
  const SpherePicture spheres = spheres_of(material);
  show.slice_ev = slice_exposure(show.reference, show.cut_deg);
  show.spheres_ev = spheres_exposure(spheres);
  const auto ev = [](double x) { return (x > 0 ? "+" : x < 0 ? "−" : "") + plain(std::abs(x)) + " EV"; };
  std::string out =
      "<section id=\"pictures\"><h2>Measured and modelled, side by side</h2>\n<div class=\"intro\"><p>The first row is "
      "the measurement, every other row a model: its <b>slice</b> (a map of how brightly it reflects; every pixel is "
      "one "
      "pair of light and camera directions), then where it is <b>darker (blue)</b> or <b>brighter (orange)</b> than "
      "the "
      "measurement, then <b>spheres</b> lit from 0° (behind the camera), 90° (the right) and 130° (almost from behind "
      "the sphere). Dashed line: the cut at " +
      cut_words(result) + ", beyond which nothing is compared.</p><figure>" + difference_legend() +
      "<figcaption>scale of every difference picture</figcaption></figure></div>\n" + reference_row(spheres, show);
  for (const Candidate* candidate : candidates_of(result))
    out += candidate_row(*candidate, candidate == &result.best, show);
  out +=
      "<p class=\"quiet\">All slices are shown at " + ev(show.slice_ev) + ", all spheres at " + ev(show.spheres_ev) +
      " (a white matte surface that faces the light has value 1 at 0 EV), in sRGB. Beyond the cut, light or camera "
      "graze the surface and measurements are poor. Hatched: no data; where a measurement ends before 90°, its sphere "
      "takes the value at 88 to 78° from the normal, if there is one. Differences compare luminances, of which those "
      "below " +
      plain(kDarkest) + " per steradian count as " + plain(kDarkest) + ".</p>\n";
  return out + "</section>\n";
}

std::string parameters_section(const Result& result) {
  const auto count = [&](auto&& is) {
    return std::count_if(result.best.estimates.begin(), result.best.estimates.end(), is);
  };
  const auto fitted = count([](const Estimate& e) { return e.fitted; });
  const auto idle = count([](const Estimate& e) { return e.fitted && !e.matters; });
  const auto bound = count([](const Estimate& e) { return e.fitted && e.matters && e.at_bound; });
  std::string out = "<section id=\"parameters\"><h2>Parameters of the fit</h2>\n";
  if (!result.best.estimates.empty())
    out += "<p>" + std::to_string(fitted) + " numbers were fitted (a color counts as three); " + std::to_string(idle) +
           " of them do not matter for this material, " + std::to_string(bound) +
           " stand at a bound. σ is the standard deviation from the covariance of the fit: how far the data "
           "leave a value free. Colors are linear RGB; swatches show them in sRGB.</p>\n";
  out += parameters_table(result.best, "Parameters of " + result.best.label);
  const std::vector<const Candidate*> all = candidates_of(result);
  for (std::size_t i = 1; i < all.size(); ++i)
    out += "<details><summary>Parameters of " + escape(all[i]->label) + "</summary>" +
           parameters_table(*all[i], "Parameters of " + all[i]->label) + "</details>\n";
  return out + "</section>\n";
}

std::string time_table(const Timing& timing) {
  const std::pair<const char*, double> parts[] = {{"reading the file", timing.load},
                                                  {"fitting the model", timing.fit},
                                                  {"fitting the baselines", timing.baselines},
                                                  {"computing the metrics", timing.metrics},
                                                  {"drawing this report", timing.report}};
  double total = 0;
  for (const auto& [name, seconds] : parts) total += seconds;
  std::string out =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"CPU time\"><table><thead><tr><th "
      "scope=\"col\">Where</th><th scope=\"col\">CPU s</th><th scope=\"col\">Share of " +
      fixed(total, 2) + " s</th></tr></thead><tbody>";
  for (const auto& [name, seconds] : parts) {
    if (seconds <= 0) continue;
    const double share = 100 * seconds / total;
    out += "<tr><td>" + std::string(name) + "</td><td class=\"n\">" + fixed(seconds, 3) +
           "</td><td class=\"wide\"><span class=\"bar\" style=\"width:" + fixed(share, 1) + "%\" title=\"" +
           fixed(share, 0) + " %\"></span></td></tr>";
  }
  return out + "</tbody></table></div>\n";
}

std::string fitting_section(const Result& result) {
  const Candidate& best = result.best;
  std::string out = "<section id=\"fitting\"><h2>How the fit went</h2>\n<div class=\"plots\">";
  if (const std::string plot = convergence_figure(best.convergence); !plot.empty())
    out += "<figure>" + plot + "<figcaption>The winning start" +
           (best.best_start >= 0 ? " (number " + std::to_string(best.best_start + 1) + " of " +
                                       std::to_string(best.start_losses.size()) + ")"
                                 : std::string()) +
           ": the loss falls until it no longer changes.</figcaption></figure>";
  if (const std::string plot = starts_figure(best.start_losses); !plot.empty())
    out +=
        "<figure>" + plot +
        "<figcaption>Where each start ended. Several starts at the level of the best one (orange) "
        "mean that the optimum is found again and again; a lone best means that it may be luck.</figcaption></figure>";
  return out + "</div>\n<h3>Time spent where</h3>\n" + time_table(result.timing) + "</section>\n";
}

std::string input_section(const Result& result) {
  const measured::Coverage& c = result.coverage;
  const auto item = [](std::string_view name, const std::string& html) {
    return element("dt", name) + "<dd>" + html + "</dd>\n";
  };
  return "<section id=\"input\"><h2>Input, and how to repeat this</h2>\n<dl>\n" +
         item("File", "<code>" + escape(result.source) + "</code>") +
         item("Format", escape(measured::kFormatNames[static_cast<std::size_t>(result.format)])) +
         item("SHA-256", "<code>" + escape(result.sha256) + "</code>") +
         item("Coverage", valid_share(c) + "; left out: " + std::to_string(c.negative) +
                              " negative (MERL marks with it what "
                              "was not measured), " +
                              std::to_string(c.not_finite) + " not finite") +
         item("Fitted on", std::string(result.options.on == Domain::kSlice ? "the standard slice" : "the whole table") +
                               ", θi and θo up to " + cut_words(result) + ", " +
                               (result.options.loss == Loss::kLog ? "log" : "cube-root") + " loss") +
         item("Pattern", escape(result.pattern.group) + " (stops against the middle: top " +
                             fixed(result.pattern.fresnel_stops, 2) + ", right " +
                             fixed(result.pattern.retroreflection_stops, 2) + ", top right corner " +
                             fixed(result.pattern.corner_stops, 2) + ")") +
         item("Program", "Likeness " LIKENESS_VERSION) + "</dl>\n<pre><code>" + escape(command_line(result)) +
         "</code></pre>\n</section>\n";
}

std::string glossary_section(const Result& result) {
  const auto item = [](std::string_view name, std::string_view text) {
    return element("dt", name) + element("dd", text) + "\n";
  };
  return "<section id=\"glossary\"><h2>Words on this page</h2>\n<dl>\n" +
         item("BRDF, f",
              "how much of the light from one direction a surface sends to another, per steradian; without the "
              "cosine.") +
         item("θi, θo", "angles of light and camera to the surface's normal.") +
         item("half vector", "the direction midway between light and camera.") +
         item("θh", "angle between half vector and normal: 0 where a mirror would reflect the light to the camera.") +
         item("θd",
              "angle between half vector and light: 0 where light and camera coincide, 90° where they face each "
              "other.") +
         item(
             "slice",
             "f over θh and θd at φd = 90°, the plane in which the talk on The Callisto Protocol compares materials.") +
         item("specular peak", "left edge: mirror reflection; its width is the roughness.") +
         item("Fresnel peak", "top: reflection that grows at grazing angles.") +
         item("retroreflection", "right edge: light sent back to where it came from, strong on rough surfaces.") +
         item("stop, EV", "a factor of two in light.") +
         item("slice error",
              "RMS difference over the slice in percent of f = 1 per steradian, values above 1 counted as 1. "
              "Dark materials have small slice errors by nature: read the log RMS beside it.") +
         item("log RMS", "RMS difference of logarithms, which weighs dark and bright parts more evenly.") +
         item(
             "tier",
             "how many of Callisto's parameters are free: base, advanced or full; 'plain' rows belong to every tier.") +
         item("cut", "samples with light or camera more than " + plain(result.options.cut_deg) +
                         "° from the normal are not used.") +
         "</dl>\n</section>\n";
}

}  // namespace

std::string command_line(const Result& result) {
  const Options& o = result.options;
  std::string out = "likeness fit " + as_shell_word(result.source) + " --model " + as_shell_word(o.model);
  if (o.tier != brdf::Tier::kPlain) out += " --tier " + std::string(brdf::kTierNames[static_cast<std::size_t>(o.tier)]);
  out += std::string(" --on ") + (o.on == Domain::kSlice ? "slice" : "table") + " --cut " + plain(o.cut_deg) +
         " --loss " + (o.loss == Loss::kLog ? "log" : "cuberoot");
  if (o.starts > 0) out += " --starts " + std::to_string(o.starts);
  return out;
}

std::string report_html(const Result& result, const measured::Material& material) {
  std::string out = page_head(result.material + ": " + result.best.label);
  out += "<header>\n<h1>" + escape(result.material) + "</h1>\n<p class=\"verdict\">" + verdict(result) + "</p>\n";
  for (const std::string& note : result.notes)
    out += "<p class=\"note\"><strong>Note.</strong> " + escape(note) + "</p>\n";
  out +=
      "<p class=\"quiet\">Percent: RMS difference over the slice, 100 % being a BRDF value of 1 per steradian; lower "
      "is nearer. " +
      escape(measured::kFormatNames[static_cast<std::size_t>(result.format)]) + ", " + valid_share(result.coverage) +
      ".</p>\n";
  out +=
      "<nav aria-label=\"On this page\"><a href=\"#pictures\">Pictures</a><a href=\"#metrics\">Metrics</a>"
      "<a href=\"#parameters\">Parameters</a><a href=\"#fitting\">How the fit went</a><a href=\"#input\">Input and "
      "command</a>"
      "<a href=\"#glossary\">Words</a></nav>\n</header>\n<main>\n";
  out += pictures_section(result, material);
  out += "<section id=\"metrics\"><h2>Metrics</h2>\n" + metrics_table(result) + "</section>\n";
  out += parameters_section(result) + fitting_section(result) + input_section(result) + glossary_section(result);
  return out + "</main>\n" + page_foot();
}

}  // namespace likeness::fit
