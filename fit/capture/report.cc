#include "fit/capture/report.h"

#include <algorithm>
#include <cmath>

#include "fit/report/tables.h"
#include "render/image/tone_curve.h"
#include "render/image/write.h"
#include "render/page/html.h"

namespace likeness::capture_fit {
namespace {

using page::element;
using page::escape;
using page::fixed;

constexpr double kShownAt = 0.8, kBrightShare = 0.99;  // the brightest hundredth is at 0.8 of the screen's light
constexpr double kFullDifference = 0.25;               // of the brightest hundredth: pure red or blue

std::uint8_t byte_of(double light) {
  return static_cast<std::uint8_t>(
      std::lround(255 * std::clamp(image::srgb_encode(std::clamp(light, 0.0, 1.0)), 0.0, 1.0)));
}
std::uint8_t plain_byte(double x) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0))); }

double bright_of(const image::Picture& picture) {
  std::vector<float> values;
  for (const float x : picture.rgb)
    if (x > 0) values.push_back(x);
  if (values.empty()) return 1;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(kBrightShare * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

template <class F>
image::DisplayPicture display(const image::Picture& picture, const F& byte) {
  image::DisplayPicture out(picture.width, picture.height);
  for (std::size_t k = 0; k < out.rgb.size(); ++k) out.rgb[k] = byte(static_cast<double>(picture.rgb[k]));
  return out;
}
image::DisplayPicture lit(const image::Picture& picture, double bright) {
  return display(picture, [&](double x) { return byte_of(kShownAt * x / bright); });
}
image::DisplayPicture normals_shown(const image::Picture& normals) {
  image::DisplayPicture out(normals.width, normals.height);
  for (std::size_t k = 0; k < out.rgb.size(); k += 3) {
    const bool is_known = normals.rgb[k] != 0 || normals.rgb[k + 1] != 0 || normals.rgb[k + 2] != 0;
    for (std::size_t c = 0; c < 3; ++c)
      out.rgb[k + c] = is_known ? plain_byte(0.5 + 0.5 * static_cast<double>(normals.rgb[k + c])) : 0;
  }
  return out;
}
// Red where the fit is too bright, blue where it is too dark, white where it is right.
image::DisplayPicture difference(const Shown& shown, double bright) {
  image::DisplayPicture out(shown.photo.width, shown.photo.height);
  for (std::size_t k = 0; k < out.rgb.size(); k += 3) {
    double over = 0;
    for (std::size_t c = 0; c < 3; ++c)
      over += static_cast<double>(shown.render.rgb[k + c] - shown.photo.rgb[k + c]) / 3;
    const double t = std::clamp(over / (kFullDifference * bright), -1.0, 1.0);
    out.rgb[k] = plain_byte(1 - std::max(-t, 0.0));
    out.rgb[k + 1] = plain_byte(1 - std::abs(t));
    out.rgb[k + 2] = plain_byte(1 - std::max(t, 0.0));
  }
  return out;
}
image::DisplayPicture channel(const image::Picture& picture, std::size_t c) {
  image::DisplayPicture out(picture.width, picture.height);
  for (std::size_t k = 0; k < out.rgb.size(); ++k)
    out.rgb[k] = plain_byte(static_cast<double>(picture.rgb[k - k % 3 + c]));
  return out;
}

std::string figure(const image::DisplayPicture& picture, std::string_view caption) {
  return "<figure><img class=\"pixels\" style=\"width:100%\" alt=\"" + escape(caption) + "\" src=\"" +
         page::png_data_url(image::png_bytes(picture)) + "\"><figcaption>" + escape(caption) +
         "</figcaption></figure>\n";
}
std::string figures(const std::vector<std::string>& of) {
  std::string out =
      "<div style=\"display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,240px),1fr));gap:12px\">\n";
  for (const std::string& one : of) out += one;
  return out + "</div>\n";
}

std::string item(std::string_view name, const std::string& text) {
  return element("dt", name) + "<dd>" + text + "</dd>\n";
}

std::string verdict(const Fit& fit) {
  const Residuals& r = fit.residuals;
  if (fit.counts.pixels == fit.counts.without_color) return "Nothing could be fitted.";
  return "The fit is within " + fixed(100 * r.callisto_rms, 1) +
         " % of a pixel's own level (root mean square, weighted); " + "Lambert's law alone is within " +
         fixed(100 * r.lambert_rms, 1) + " %.";
}

std::string reasons(const Fit& fit) {
  std::string out = "<h3>Left as they are, and why</h3>\n<dl>\n";
  for (const fit::Estimate& e : fit.estimates)
    if (!e.fitted && e.why != "not searched") out += item(e.name, escape(e.why) + "; kept at " + page::plain(e.value));
  std::string rest;
  for (const fit::Estimate& e : fit.estimates)
    if (e.why == "not searched") rest += (rest.empty() ? "" : ", ") + e.name;
  return out +
         item("the others",
              "not searched, because one camera and one light at a time say little of them: " + escape(rest)) +
         "</dl>\n";
}

std::string counts_section(const Fit& fit) {
  const Counts& c = fit.counts;
  const auto of = [](std::size_t n, std::size_t all) {
    return std::to_string(n) +
           (all > 0 ? " (" + fixed(100 * static_cast<double>(n) / static_cast<double>(all), 2) + " %)" : "");
  };
  return "<section id=\"counts\"><h2>What was seen</h2>\n<dl>\n" +
         item("lights", std::to_string(c.lights) + " with a photograph and a place, from " +
                            std::to_string(c.light_directions) + " directions") +
         item("pixels", std::to_string(c.pixels) + " inside the mask") +
         item("without a normal", of(c.without_normal, c.pixels)) +
         item("seen by no light", of(c.seen_by_none, c.pixels)) +
         item("seen by one light or two", of(c.seen_by_few, c.pixels)) +
         item("lit from one plane", of(c.in_one_plane, c.pixels)) +
         item("without a color", of(c.without_color, c.pixels)) +
         item("samples", std::to_string(c.samples) + ", a pixel under a light each") +
         item("clipped", of(c.clipped, c.samples) + ", left out") +
         item("not finite", of(c.not_finite, c.samples) + ", left out") +
         item("negative", of(c.negative, c.samples) + ", used: noise about black has both signs") +
         "</dl>\n</section>\n";
}

}  // namespace

std::string report_html(const capture::Capture& capture, const Fit& fit, const std::vector<Shown>& shown,
                        const Asked& asked) {
  const std::string& camera = capture.cameras[fit.camera].id;
  std::string out = page::page_head(capture.name + ": fit of " + camera);
  out += "<header>\n<h1>" + escape(capture.name.empty() ? camera : capture.name) + "</h1>\n<p class=\"verdict\">" +
         verdict(fit) + "</p>\n";
  for (const std::string& note : fit.notes)
    out += "<p class=\"note\"><strong>Note.</strong> " + escape(note) + "</p>\n";
  out += "<p class=\"quiet\">Camera " + escape(camera) + ", normals " +
         std::string(fit.normals_from == NormalSource::kGiven ? "given by the capture"
                                                              : "estimated from the photographs") +
         ".</p>\n<nav aria-label=\"On this page\"><a href=\"#maps\">Maps</a><a href=\"#photos\">Photographs</a>"
         "<a href=\"#parameters\">Parameters</a><a href=\"#counts\">What was seen</a><a href=\"#input\">Input and "
         "command</a></nav>\n</header>\n<main>\n";
  const double bright = bright_of(fit.base_colors);
  out +=
      "<section id=\"maps\"><h2>Maps</h2>\n" +
      figures({figure(normals_shown(fit.normals),
                      "Normals in the world: x, y, z from -1 to 1 as red, green, blue. "
                      "Black: not known"),
               figure(lit(fit.base_colors, bright), "Base colors, brightened so that " + page::number(bright, 2) +
                                                        " is at 0.8 of the screen's light"),
               figure(channel(fit.confidence, 0),
                      "Share of the lights that the fit agrees with. White: all; dark: "
                      "shadow, highlight, or turned away"),
               figure(channel(fit.confidence, 1),
                      fit.normals_from == NormalSource::kGiven
                          ? std::string("Trust in the normal: given, so 1 wherever there is one")
                          : std::string(
                                "Trust in the normal. White: its standard error is 0; black: 10 degrees or more"))}) +
      "</section>\n<section id=\"photos\"><h2>Photographs and the fit</h2>\n<p>No shadow is cast and no light is "
      "scattered twice in the fit, so those are what the difference shows first.</p>\n";
  for (const Shown& s : shown) {
    const double level = bright_of(s.photo);
    out += "<h3>Light " + escape(capture.lights[s.light].id) + "</h3>\n" +
           figures({figure(lit(s.photo, level), "Photograph"), figure(lit(s.render, level), "Fit, same exposure"),
                    figure(difference(s, level),
                           "Difference. Red: the fit is too bright; blue: too dark; full color at "
                           "a quarter of the photograph's brightest")});
  }
  fit::Candidate candidate;
  candidate.brdf = fit.material;
  candidate.estimates = fit.estimates;
  const Residuals& r = fit.residuals;
  out += "</section>\n<section id=\"parameters\"><h2>The material that all pixels share</h2>\n" +
         fit::parameters_table(candidate, "Parameters of Callisto") + reasons(fit) +
         "<p>σ takes the pixels as independent of one another and each pixel's residuals as they are. Normals are "
         "taken as "
         "exact, and neighbouring pixels err alike: read it as a lower bound.</p>\n<h3>How near</h3>\n<dl>\n" +
         item("loss", page::number(r.callisto_loss, 4) + " against " + page::number(r.lambert_loss, 4) +
                          " of Lambert: mean of ln(1 + (r / scale)²)") +
         item("scale", fixed(100 * r.scale, 2) + " % of a pixel's level: a residual of this size has half the weight") +
         item("exposure", page::number(fit.exposure, 4)) + "</dl>\n</section>\n" + counts_section(fit);
  return out + "<section id=\"input\"><h2>Input, and how to repeat this</h2>\n<dl>\n" +
         item("Capture", "<code>" + escape(asked.capture) + "</code>") + item("Program", "Likeness " LIKENESS_VERSION) +
         item("Time", fixed(fit.read_seconds, 1) + " s reading, " +
                          fixed(fit.normal_seconds + fit.material_seconds + fit.color_seconds, 1) + " s fitting") +
         "</dl>\n<pre><code>" + escape(asked.command) + "</code></pre>\n</section>\n</main>\n" + page::page_foot();
}

}  // namespace likeness::capture_fit
