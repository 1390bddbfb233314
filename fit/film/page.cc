#include "fit/film/page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "render/image/tone_curve.h"
#include "render/page/html.h"
#include "render/page/line_plot.h"

namespace likeness::film {
namespace {

using Json = nlohmann::ordered_json;
using page::element;
using page::fixed;

constexpr std::array<double, 5> kAngles{0, 10, 20, 30, 40};  // of incidence, for the sensitivity
constexpr double kLeastOfTalk = 0.025, kMostOfTalk = 0.055;

std::string percent(double share, int decimals = 2) { return fixed(100 * share, decimals) + " %"; }

std::string intervals(const std::vector<Interval>& region) {
  std::string out;
  for (const Interval& part : region)
    out += (out.empty() ? "" : " and ") + fixed(part.low, 0) + " to " + fixed(part.high, 0);
  return out + " nm";
}

std::string candidates(const Estimate& estimate) {
  std::string out;
  for (const Candidate& at : estimate.candidates) out += (out.empty() ? "" : ", ") + fixed(at.thickness_nm, 1);
  return out + " nm";
}

std::string percentiles(const std::array<double, 5>& five) {
  if (std::isnan(five[2])) return "-";
  return fixed(five[2], 0) + " (" + fixed(five[1], 0) + " to " + fixed(five[3], 0) + "; " + fixed(five[0], 0) + " to " +
         fixed(five[4], 0) + ") nm";
}

// The study at another angle, without a bootstrap.
Study at_angle(const Told& told, double degrees) {
  Options options = told.options;
  options.eye.incidence_deg = degrees;
  options.resamples = 0;
  return study_of(told.readings, options);
}

Json json_of(const Estimate& estimate) {
  Json out;
  for (const Candidate& at : estimate.candidates)
    out["candidates"].push_back({{"thickness_nm", at.thickness_nm}, {"scale", at.scale}, {"chi2", at.chi2}});
  const auto region = [](const std::vector<Interval>& parts) {
    Json list = Json::array();
    for (const Interval& part : parts) list.push_back({part.low, part.high});
    return list;
  };
  out["region_68_nm"] = region(estimate.region68);
  out["region_95_nm"] = region(estimate.region95);
  return out;
}

std::string row(std::initializer_list<std::string> cells) {
  std::string out = "<tr>";
  for (const std::string& cell : cells) out += "<td>" + page::escape(cell) + "</td>";
  return out + "</tr>\n";
}

std::string header(std::initializer_list<std::string_view> cells) {
  std::string out = "<thead><tr>";
  for (const std::string_view cell : cells) out += element("th", cell);
  return out + "</tr></thead>\n";
}

std::string swatch(const std::array<double, 3>& rgb, double gain) {
  std::string color = "rgb(";
  for (std::size_t c = 0; c < 3; ++c)
    color += (c == 0 ? "" : ",") + std::to_string(image::srgb_encode8(static_cast<float>(gain * rgb[c])));
  return "<span class=\"swatch\" style=\"background:" + color + ")\"></span>";
}

// A color of the page for a wavelength, dark enough on white; not what the eye sees of it.
std::string line_color(std::size_t index) {
  static constexpr std::array<const char*, 5> kColors{"#0b7d4b", "#b3261e", "#0b5394", "#8a5a00", "#6a3d9a"};
  return kColors[index % kColors.size()];
}

std::string spectra_plot(const Told& told) {
  page::LinePlot plot{
      .title = "Reflectance against wavelength for several thicknesses, with the means of the readings.",
      .across = {"wavelength [nm]", 380, 780, false},
      .up = {"reflectance [%]", 0, 7, false}};
  const Candidate& best = told.chosen().best();
  static constexpr std::array<const char*, 5> kDashes{"2 3", "6 3", "10 4", "8 3 2 3", "3 6"};
  std::size_t index = 0;
  const auto add = [&](double nm, double scale, const std::string& name, const std::string& color, const char* dash,
                       double width) {
    page::PlotLine line{name, {}, color, dash, width};
    for (double w = 380; w <= 780; w += 5)
      line.points.push_back({w, 100 * scale * told.options.eye.reflectance(nm, w)});
    plot.lines.push_back(line);
  };
  for (const double nm : {0.0, 30.0, 60.0, 90.0, 150.0}) {
    add(nm, 1, fixed(nm, 0) + " nm" + (nm == 0 ? ": tears without a film" : ""), "#7a828d", kDashes[index], 1.2);
    ++index;
  }
  add(best.thickness_nm, best.scale, fixed(best.thickness_nm, 1) + " nm x scale " + fixed(best.scale, 3) + ": the fit",
      "#0b5394", "", 2.2);
  const std::vector<double> mean = told.readings.mean(), spread = told.readings.deviation();
  for (std::size_t i = 0; i < mean.size(); ++i)
    plot.dots.push_back(
        {{told.readings.wavelengths_nm[i], 100 * mean[i]}, 100 * spread[i], "#1c1f23", percent(mean[i]), 4});
  plot.dots_name = told.readings.subjects.size() > 1
                       ? "mean of the readings, and one standard deviation of the subjects"
                       : "the readings";
  return drawing_of(plot);
}

std::string thickness_plot(const Told& told) {
  page::LinePlot plot{.title =
                          "Reflectance against thickness at each wavelength, with the readings of each subject where "
                          "its own fit stands.",
                      .across = {"thickness [nm]", 0, told.options.most_nm, false},
                      .up = {"reflectance [%]", 0, 7, false}};
  const std::vector<Estimate>& own = told.follows_scale ? told.study.scaled_subjects : told.study.absolute_subjects;
  const double scale = told.chosen().best().scale;
  for (std::size_t i = 0; i < told.readings.wavelengths_nm.size(); ++i) {
    const double nm = told.readings.wavelengths_nm[i];
    page::PlotLine line{fixed(nm, 0) + " nm" + (scale == 1.0 ? "" : " x scale " + fixed(scale, 3)),
                        {},
                        line_color(i),
                        i % 2 == 0 ? "" : "6 3",
                        1.8};
    for (double d = 0; d <= told.options.most_nm; d += 1)
      line.points.push_back({d, 100 * scale * told.options.eye.reflectance(d, nm)});
    plot.lines.push_back(line);
    for (std::size_t s = 0; s < own.size(); ++s)
      plot.dots.push_back({{own[s].best().thickness_nm, 100 * told.readings.subjects[s].reflectance[i]},
                           0,
                           line_color(i),
                           "subject " + told.readings.subjects[s].name,
                           3});
  }
  plot.dots_name = "a reading, at the thickness that fits its subject best";
  return drawing_of(plot);
}

std::string likelihood_plot(const Told& told) {
  page::LinePlot plot{.title = "Likelihood of the thickness relative to the best.",
                      .across = {"thickness [nm]", 0, told.options.most_nm, false},
                      .up = {"likelihood relative to the best", 0, 1.05, false}};
  const auto add = [&](const Estimate& estimate, const std::string& name, const std::string& color,
                       const std::string& dash) {
    page::PlotLine line{name, {}, color, dash, 1.8};
    for (std::size_t k = 0; k < estimate.chi2.size(); ++k)
      line.points.push_back(
          {kStepNm * static_cast<double>(k), std::exp(-0.5 * (estimate.chi2[k] - estimate.best().chi2))});
    plot.lines.push_back(line);
  };
  add(told.study.scaled, "scale fitted: the ratio of the means decides", "#0b5394", "");
  add(told.study.absolute, "scale 1: the readings at their word", "#b35806", "6 3");
  for (const Interval& part : told.chosen().region95)
    plot.bands.push_back({part.low, part.high, plot.bands.empty() ? "95 % region of the chosen one" : "", "#e3ecf7"});
  return drawing_of(plot);
}

std::string verdict(const Told& told) {
  const Candidate& best = told.chosen().best();
  const std::array<double, 3> rgb = told.options.eye.color(best.thickness_nm);
  return "A film of " + fixed(best.thickness_nm, 0) + " nm (95 %: " + intervals(told.chosen().region95) +
         "), which head on reflects " + percent(luminance(rgb)) + ".";
}

}  // namespace

std::string text_of(const Told& told) {
  const Readings& readings = told.readings;
  const Eye& eye = told.options.eye;
  const std::vector<double> mean = readings.mean(), spread = readings.deviation();
  std::string out = readings.source + ": " + std::to_string(readings.subjects.size()) + " subjects, light at " +
                    fixed(eye.incidence_deg, 0) + " deg\n";
  for (std::size_t i = 0; i < mean.size(); ++i)
    out += "  " + fixed(readings.wavelengths_nm[i], 0) + " nm  " + percent(mean[i]) +
           (readings.subjects.size() > 1 ? ", standard deviation " + percent(spread[i]) : "") + "\n";
  const auto block = [&](std::string_view name, const Estimate& e, const std::array<double, 5>& five) {
    out += "\n" + std::string(name) + "\n  thickness   " + candidates(e) + "   scale " + fixed(e.best().scale, 3) +
           ", chi2 " + page::number(e.best().chi2) + "\n  68 %        " + intervals(e.region68) + "\n  95 %        " +
           intervals(e.region95) + "\n  bootstrap   " + percentiles(five) + "\n";
  };
  block("Scale fitted (ratios decide)", told.study.scaled, told.study.scaled_bootstrap);
  block("Scale 1 (readings at their word)", told.study.absolute, told.study.absolute_bootstrap);
  const std::array<double, 3> rgb = eye.color(told.chosen().best().thickness_nm);
  const Range range = luminance_range(eye, told.options.most_nm);
  out += "\nHead on, at " + fixed(told.chosen().best().thickness_nm, 1) + " nm\n  f0          " + fixed(rgb[0], 4) +
         " " + fixed(rgb[1], 4) + " " + fixed(rgb[2], 4) + "   linear Rec. 709, luminance " + fixed(luminance(rgb), 4) +
         "\n  specular    " + fixed(luminance(rgb) / 0.08, 3) + "   (f0 = 0.08 specular)\n  range       " +
         percent(range.least) + " without a film to " + percent(range.most) + " at " + fixed(range.most_at_nm, 0) +
         " nm; 2.5 % at " + fixed(thickness_of_luminance(eye, kLeastOfTalk, told.options.most_nm), 0) +
         " nm, 5.5 % at " + fixed(thickness_of_luminance(eye, kMostOfTalk, told.options.most_nm), 0) + " nm\n";
  return out;
}

std::string json_of(const Told& told) {
  const Readings& readings = told.readings;
  const Eye& eye = told.options.eye;
  Json out{{"format", "likeness film"}, {"version", 1}, {"source", readings.source}};
  out["model"] = {{"film_index", eye.film_index},
                  {"tear_index", eye.tear_index},
                  {"incidence_deg", eye.incidence_deg},
                  {"most_nm", told.options.most_nm},
                  {"error_of_one_reading", told.options.error}};
  out["wavelengths_nm"] = readings.wavelengths_nm;
  out["mean"] = readings.mean();
  out["deviation"] = readings.deviation();
  out["chosen"] = told.follows_scale ? "scaled" : "absolute";
  const auto with_bootstrap = [](Json estimate, const std::array<double, 5>& five) {
    if (!std::isnan(five[2]))
      estimate["bootstrap_nm"] = {
          {"p2.5", five[0]}, {"p16", five[1]}, {"p50", five[2]}, {"p84", five[3]}, {"p97.5", five[4]}};
    return estimate;
  };
  out["scaled"] = with_bootstrap(json_of(told.study.scaled), told.study.scaled_bootstrap);
  out["absolute"] = with_bootstrap(json_of(told.study.absolute), told.study.absolute_bootstrap);
  for (std::size_t s = 0; s < readings.subjects.size(); ++s)
    out["subjects"].push_back({{"name", readings.subjects[s].name},
                               {"reflectance", readings.subjects[s].reflectance},
                               {"scaled", json_of(told.study.scaled_subjects[s])},
                               {"absolute", json_of(told.study.absolute_subjects[s])}});
  for (const double degrees : kAngles) {
    const Study study = at_angle(told, degrees);
    out["by_incidence"].push_back({{"incidence_deg", degrees},
                                   {"scaled_nm", study.scaled.best().thickness_nm},
                                   {"absolute_nm", study.absolute.best().thickness_nm}});
  }
  const std::array<double, 3> rgb = eye.color(told.chosen().best().thickness_nm);
  const Range range = luminance_range(eye, told.options.most_nm);
  out["head_on"] = {{"f0", rgb},
                    {"luminance", luminance(rgb)},
                    {"specular", luminance(rgb) / 0.08},
                    {"least", range.least},
                    {"most", range.most},
                    {"most_at_nm", range.most_at_nm}};
  return out.dump(2) + "\n";
}

std::string page_of(const Told& told) {
  const Readings& readings = told.readings;
  const Eye& eye = told.options.eye;
  std::string out = page::page_head("The film on the eye");
  out += element("h1", "The film on the eye");
  out += "<p class=\"verdict\">" + page::escape(verdict(told)) + "</p>\n";
  out += element("p", "Readings: " + readings.source + ". Air, oil of index " + page::plain(eye.film_index) +
                          ", tears of index " + page::plain(eye.tear_index) + ", light at " +
                          page::plain(eye.incidence_deg) + " degrees to the normal.");
  out += "<div class=\"plots\"><figure>" + spectra_plot(told) + "</figure><figure>" + thickness_plot(told) +
         "</figure><figure>" + likelihood_plot(told) + "</figure></div>\n";

  out += element("h2", "Two readings of the same numbers");
  out += element(
      "p",
      "Where the scale of the instrument is fitted, only ratios between wavelengths decide. The ratio rises with the "
      "thickness to a "
      "flat top and falls again, so that two thicknesses can explain it equally well, and the interval is wide. "
      "Where the readings are taken at their word, their height decides, and the interval is narrow, but an error of "
      "the "
      "instrument's scale goes straight into it.");
  out += "<div class=\"scroll\"><table>" + header({"", "thickness, best first", "scale", "chi2", "68 %", "95 %",
                                                   "bootstrap: median (68 %; 95 %)", "luminance of f0", "specular"});
  const auto estimate_row = [&](const std::string& name, const Estimate& e, const std::array<double, 5>& five) {
    const double y = luminance(eye.color(e.best().thickness_nm));
    return row({name, candidates(e), fixed(e.best().scale, 3), page::number(e.best().chi2), intervals(e.region68),
                intervals(e.region95), percentiles(five), fixed(y, 4), fixed(y / 0.08, 3)});
  };
  out += "<tbody>" + estimate_row("scale fitted", told.study.scaled, told.study.scaled_bootstrap) +
         estimate_row("scale 1", told.study.absolute, told.study.absolute_bootstrap) + "</tbody></table></div>\n";

  out += element("h2", "What a game should use");
  const Range range = luminance_range(eye, told.options.most_nm);
  out += element(
      "p", "Tears alone reflect " + percent(range.least) +
               " head on, which is what the index of water says. Oil on them adds up to " + percent(range.most) +
               ", at " + fixed(range.most_at_nm, 0) + " nm. The range 2.5 to 5.5 % is that of films from " +
               fixed(thickness_of_luminance(eye, kLeastOfTalk, told.options.most_nm), 0) + " to " +
               fixed(thickness_of_luminance(eye, kMostOfTalk, told.options.most_nm), 0) +
               " nm. Use the row of the fit as the default, and move along the table for an eye that is dry or moved.");
  out += "<div class=\"scroll\"><table>" +
         header({"thickness", "f0, linear Rec. 709", "luminance", "specular (f0 = 0.08 specular)", "color x 16"}) +
         "<tbody>";
  std::vector<double> rows{0, 20, 40, 60, 80, 100, 150, 200};
  const double best = told.chosen().best().thickness_nm;
  std::erase_if(rows, [&](double nm) { return nm > told.options.most_nm || std::abs(nm - best) < 1e-6; });
  rows.push_back(best);
  std::sort(rows.begin(), rows.end());
  for (const double nm : rows) {
    const std::array<double, 3> rgb = eye.color(nm);
    out += std::string("<tr") + (nm == best ? " class=\"fit\"" : "") + "><td" + (nm == best ? " class=\"best\"" : "") +
           ">" + fixed(nm, nm == best ? 1 : 0) + " nm" + (nm == best ? " (the fit)" : "") + "</td><td>" +
           fixed(rgb[0], 4) + " " + fixed(rgb[1], 4) + " " + fixed(rgb[2], 4) + "</td><td>" + percent(luminance(rgb)) +
           "</td><td>" + fixed(luminance(rgb) / 0.08, 3) + "</td><td>" + swatch(rgb, 16) + "</td></tr>\n";
  }
  out += "</tbody></table></div>\n";

  out += element("h2", "Each subject");
  out += element("p", "By the error of one reading, " + percent(told.options.error, 1) +
                          " of it, which is an assumption (--error): tables of readings rarely "
                          "say it. A chi2 far above 4 says that no thickness explains the subject's readings.");
  out += "<div class=\"scroll\"><table>" +
         header({"subject", "readings", "scale of the means: thickness", "95 %", "chi2", "scale 1: thickness", "95 %",
                 "chi2"}) +
         "<tbody>";
  for (std::size_t s = 0; s < readings.subjects.size(); ++s) {
    std::string values;
    for (const double value : readings.subjects[s].reflectance) values += (values.empty() ? "" : ", ") + percent(value);
    const Estimate &a = told.study.scaled_subjects[s], &b = told.study.absolute_subjects[s];
    out += row({readings.subjects[s].name, values, candidates(a), intervals(a.region95), page::number(a.best().chi2),
                candidates(b), intervals(b.region95), page::number(b.best().chi2)});
  }
  out += "</tbody></table></div>\n";

  out += element("h2", "If the light came at another angle");
  out += "<div class=\"scroll\"><table>" + header({"incidence", "scale fitted", "scale 1"}) + "<tbody>";
  for (const double degrees : kAngles) {
    const Study study = at_angle(told, degrees);
    out += row({fixed(degrees, 0) + " deg", fixed(study.scaled.best().thickness_nm, 1) + " nm",
                fixed(study.absolute.best().thickness_nm, 1) + " nm"});
  }
  return out + "</tbody></table></div>\n" + page::page_foot();
}

}  // namespace likeness::film
