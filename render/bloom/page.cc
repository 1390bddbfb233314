#include "render/bloom/page.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "render/page/html.h"
#include "render/page/line_plot.h"

namespace likeness::bloom {
namespace {

using page::element;
using page::fixed;
using page::number;

constexpr std::array<const char*, 3> kChannelNames{"red", "green", "blue"};
constexpr std::array<const char*, 3> kChannelColors{"#b3261e", "#0b7d4b", "#0b5394"};
constexpr std::array<const char*, 3> kChannelDashes{"", "7 3", "2 3"};

std::string_view name_of(Family family) {
  return std::find_if(kFamilies.begin(), kFamilies.end(), [&](const FamilyRow& row) { return row.family == family; })
      ->name;
}

std::string three(const std::array<double, 3>& values, int digits = 3) {
  return number(values[0], digits) + " " + number(values[1], digits) + " " + number(values[2], digits);
}

double least_above_zero(const std::array<std::vector<double>, 3>& values, double least) {
  for (const auto& channel : values)
    for (const double value : channel)
      if (value > 0) least = std::min(least, value);
  return least;
}

std::string profile_plot(const Fit& fit) {
  double most = 0;
  for (const auto& channel : fit.model)
    for (const double value : channel) most = std::max(most, value);
  const double least = std::max(least_above_zero(fit.glare, most), most * 1e-9);
  page::LinePlot plot{
      .title = "Light against the distance from the source, both logarithmic: photograph, fit, source.",
      .across = {"distance from the source [pixels]", 0.4, fit.radius.back() * 1.1, true},
      .up = {"light", std::pow(10, std::floor(std::log10(least))), std::pow(10, std::ceil(std::log10(most))), true}};
  for (std::size_t c = 0; c < 3; ++c) {
    page::PlotLine model{std::string("fit, ") + kChannelNames[c], {}, kChannelColors[c], kChannelDashes[c], 1.6};
    page::PlotLine source{c == 1 ? "the source without glare, green" : "", {}, "#9aa1ab", "1 3", 1.4};
    for (std::size_t i = 0; i < fit.radius.size(); ++i) {
      model.points.push_back({std::max(0.4, fit.radius[i]), fit.model[c][i]});
      source.points.push_back({std::max(0.4, fit.radius[i]), fit.source[c][i]});
      plot.dots.push_back({{std::max(0.4, fit.radius[i]), fit.glare[c][i]}, fit.error[c][i], kChannelColors[c], "", 2});
    }
    plot.lines.push_back(model);
    if (c == 1) plot.lines.push_back(source);
  }
  plot.dots_name = "photograph with glare, mean of a ring and its standard error";
  return drawing_of(plot);
}

std::string rest_plot(const Fit& fit) {
  page::LinePlot plot{.title = "Photograph less fit, in standard errors, against distance.",
                      .across = {"distance from the source [pixels]", 0.4, fit.radius.back() * 1.1, true},
                      .up = {"photograph less fit [standard errors]", -6, 6, false}};
  plot.lines.push_back({"", {{0.4, 0}, {fit.radius.back() * 1.1, 0}}, "#555c66", "", 1});
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < fit.radius.size(); ++i)
      plot.dots.push_back(
          {{std::max(0.4, fit.radius[i]), std::clamp((fit.glare[c][i] - fit.model[c][i]) / fit.error[c][i], -6.0, 6.0)},
           0,
           kChannelColors[c],
           kChannelNames[c],
           2.5});
  plot.dots_name = "red, green, blue; beyond 6 at the edge";
  return drawing_of(plot);
}

std::string kernel_plot(const Fit& fit) {
  page::LinePlot plot{.title = "The kernel of green, and its components.",
                      .across = {"distance [pixels]", 0.4, static_cast<double>(fit.kernel.radius), true},
                      .up = {"share of the light per pixel, green", 1e-10, 1, true}};
  static constexpr std::array<const char*, 6> kDashes{"7 3", "2 3", "10 3 2 3", "4 4", "1 2", "12 3"};
  page::PlotLine whole{"all scattered light", {}, "#1c1f23", "", 2.2};
  std::vector<page::PlotLine> parts;
  for (std::size_t k = 0; k < fit.kernel.components.size(); ++k) {
    const Component& at = fit.kernel.components[k];
    parts.push_back({std::string(name_of(at.family)) + ", scale " + number(at.scale) + " pixels, " +
                         number(100 * at.weight[1]) + " %",
                     {},
                     "#8a5a00",
                     kDashes[k % kDashes.size()],
                     1.4});
  }
  for (double r = 0.4; r <= fit.kernel.radius; r *= 1.05) {
    double sum = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const double value = fit.kernel.components[k].weight[1] *
                           density(fit.kernel.components[k].family, fit.kernel.components[k].scale, r);
      parts[k].points.push_back({r, value});
      sum += value;
    }
    whole.points.push_back({r, sum});
  }
  plot.lines.push_back(whole);
  plot.lines.insert(plot.lines.end(), parts.begin(), parts.end());
  return drawing_of(plot);
}

double scattered(const Fit& fit) {
  return 1 - (fit.kernel.direct[0] + fit.kernel.direct[1] + fit.kernel.direct[2]) / 3;
}

std::string verdict(const Fit& fit) {
  return number(100 * scattered(fit)) + " % of the light is scattered, by " +
         std::to_string(fit.kernel.components.size()) +
         (fit.kernel.components.size() == 1 ? " component." : " components.");
}

std::string warning(const Fit& fit) {
  if (!fit.is_direct_seen)
    return "The source's own pixels are clipped: that both photographs have the same light is assumed, not measured.";
  for (const double scale : fit.scale)
    if (std::abs(scale - 1) > 0.05)
      return "The photograph with glare has " + three(fit.scale) +
             " times the light of the other: another exposure, or light that left the square.";
  return "";
}

}  // namespace

std::string summary_of(const Fit& fit) {
  std::string out = verdict(fit) + "\n  direct     " + three(fit.kernel.direct, 4) + "\n";
  for (const Component& at : fit.kernel.components)
    out += "  " + std::string(name_of(at.family)) + std::string(11 - name_of(at.family).size(), ' ') + "scale " +
           number(at.scale, 4) + " +- " + number(at.scale_error, 2) + " pixels, weight " + three(at.weight) + " +- " +
           three(at.weight_error, 2) + "\n";
  out += "  misfit     " + number(fit.misfit) + " (chi2 per degree of freedom, " + std::to_string(fit.radius.size()) +
         " rings)\n";
  if (fit.clip)
    out += "  clipped    " + std::to_string(fit.clipped) + " pixels from " + number(*fit.clip) + " on, not used\n";
  if (const std::string text = warning(fit); !text.empty()) out += "  " + text + "\n";
  return out;
}

std::string json_of(const Fit& fit) {
  nlohmann::ordered_json out = nlohmann::ordered_json::parse(text_of(fit.kernel));
  nlohmann::ordered_json how{{"scale", fit.scale},
                             {"direct_is_seen", fit.is_direct_seen},
                             {"clipped_pixels", fit.clipped},
                             {"misfit", fit.misfit}};
  if (fit.clip) how["clip"] = *fit.clip;
  for (const Trial& trial : fit.trials)
    how["trials"].push_back(
        {{"components", trial.components}, {"held_out", trial.held_out}, {"held_out_error", trial.held_out_error}});
  out["fit"] = how;
  return out.dump(2) + "\n";
}

std::string page_of(const Fit& fit, const std::string& source, const std::string& glare) {
  std::string out = page::page_head("Bloom");
  out += element("h1", "Bloom") + "<p class=\"verdict\">" + page::escape(verdict(fit)) + "</p>\n";
  out += element("p", "With glare: " + glare + ". Without: " + source + ".");
  if (const std::string text = warning(fit); !text.empty()) out += "<p class=\"note\">" + page::escape(text) + "</p>\n";
  out += "<div class=\"plots\"><figure>" + profile_plot(fit) + "</figure><figure>" + rest_plot(fit) +
         "</figure><figure>" + kernel_plot(fit) + "</figure></div>\n";
  out += element("h2", "The kernel");
  out +=
      "<div class=\"scroll\"><table><thead><tr><th>component</th><th>scale [pixels]</th><th>weight: red, green, "
      "blue</th><th>one standard deviation</th></tr></thead><tbody>";
  out += "<tr><td>direct: light that stays</td><td></td><td>" + three(fit.kernel.direct, 4) + "</td><td></td></tr>";
  for (const Component& at : fit.kernel.components)
    out += "<tr><td>" + std::string(name_of(at.family)) + "</td><td>" + number(at.scale, 4) + " ± " +
           number(at.scale_error, 2) + "</td><td>" + three(at.weight, 4) + "</td><td>" + three(at.weight_error, 2) +
           "</td></tr>";
  out += "</tbody></table></div>\n" + element("h2", "How many components");
  out += element("p",
                 "Each fourth ring was left out in turn and foretold from the others; 1 is noise alone. The fewest "
                 "components within one standard error of the best were taken.");
  out +=
      "<div class=\"scroll\"><table><thead><tr><th>components</th><th>misfit of rings left out</th><th>standard "
      "error</th></tr></thead><tbody>";
  for (const Trial& trial : fit.trials)
    out += std::string("<tr><td") +
           (static_cast<std::size_t>(trial.components) == fit.kernel.components.size() ? " class=\"best\"" : "") + ">" +
           std::to_string(trial.components) + "</td><td>" + number(trial.held_out) + "</td><td>" +
           number(trial.held_out_error) + "</td></tr>";
  out += "</tbody></table></div>\n";
  return out + page::page_foot();
}

}  // namespace likeness::bloom
