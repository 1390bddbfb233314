#include "render/blood/palette_page.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "render/image/tone_curve.h"
#include "render/image/write.h"
#include "render/page/html.h"

namespace likeness::blood {
namespace {

using page::element;
using page::number;
using Palette = brdf::BloodPalette<double>;

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value / static_cast<double>(values.size());
  return sum;
}
double largest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

std::string css_color(const std::array<double, 3>& rgb) {
  std::string out = "rgb(";
  for (std::size_t c = 0; c < 3; ++c)
    out += (c == 0 ? "" : ",") + std::to_string(image::srgb_encode8(static_cast<float>(rgb[c])));
  return out + ")";
}

std::string clock_text(double seconds) {
  const auto minutes = static_cast<int>(std::lround(seconds / 60));
  if (seconds < 60 && seconds > 0) return page::plain(seconds) + " s";
  return minutes < 60 ? std::to_string(minutes) + " min" : page::plain(std::round(seconds / 360) / 10) + " h";
}

std::string line(std::string_view name, const std::vector<double>& values) {
  return "  " + std::string(name) + "mean " + number(mean(values)) + ", largest " + number(largest(values)) + "\n";
}

// One side of the comparison: a row for each opacity, a column for each time.
template <class ColorAt>
std::string swatches(const Table& table, ColorAt&& color_at) {
  std::set<double> opacities, times;
  for (const Cell& cell : table.cells) opacities.insert(cell.opacity), times.insert(cell.time);
  std::string out = "<table style=\"font-size:.8rem\"><thead><tr><th>opacity</th>";
  for (const double time : times) out += element("th", clock_text(time));
  out += "</tr></thead><tbody>";
  for (const double opacity : opacities) {
    out += "<tr><th style=\"min-width:0\">" + page::plain(opacity) + "</th>";
    for (const double time : times) {
      const auto at = std::find_if(table.cells.begin(), table.cells.end(),
                                   [&](const Cell& c) { return c.opacity == opacity && c.time == time; });
      out += at == table.cells.end() ? "<td></td>"
                                     : "<td style=\"background:" + css_color(color_at(*at)) + "\">&nbsp;</td>";
    }
    out += "</tr>";
  }
  return out + "</tbody></table>";
}

}  // namespace

std::string summary_of(const Table& table, const PaletteFit& fit) {
  std::string out = table.source + ": " + std::to_string(table.cells.size()) + " cells\nDelta E 2000\n" +
                    line("spectra alone     ", fit.spectral) + line("palette           ", fit.fitted) +
                    line("cells left out    ", fit.held_out);
  for (std::size_t i = 0; i < Palette::kCount; ++i)
    out += "  " + std::string(Palette::kParameters[i].name) +
           std::string(18 - Palette::kParameters[i].name.size(), ' ') + number(fit.palette.value[i], 4) + " " +
           std::string(Palette::kParameters[i].unit) + "\n";
  return out;
}

std::string json_of(const Table& table, const PaletteFit& fit) {
  nlohmann::ordered_json out{{"format", "likeness blood palette"}, {"version", 1}, {"source", table.source}};
  for (std::size_t i = 0; i < Palette::kCount; ++i)
    out["parameters"][std::string(Palette::kParameters[i].name)] = fit.palette.value[i];
  out["longest_s"] = fit.palette.longest;
  out["spline"] = {{"across", Palette::kAcross}, {"along", Palette::kAlong}, {"coefficients", fit.palette.spline}};
  if (std::isfinite(fit.smoothness)) out["spline"]["smoothness"] = fit.smoothness;
  const auto errors = [](const std::vector<double>& values) {
    return nlohmann::ordered_json{{"mean", mean(values)}, {"largest", largest(values)}};
  };
  out["delta_e_2000"] = {
      {"spectra", errors(fit.spectral)}, {"palette", errors(fit.fitted)}, {"left_out", errors(fit.held_out)}};
  for (std::size_t k = 0; k < table.cells.size(); ++k) {
    const Cell& cell = table.cells[k];
    out["cells"].push_back({{"drop", cell.drop},
                            {"opacity", cell.opacity},
                            {"time_s", cell.time},
                            {"rgb", cell.rgb},
                            {"palette", color_of(fit.palette, cell.opacity, cell.time)},
                            {"delta_e", fit.fitted[k]},
                            {"left_out", fit.held_out[k]}});
  }
  return out.dump(1) + "\n";
}

std::string page_of(const Table& table, const PaletteFit& fit) {
  std::string out = page::page_head("Colors of blood");
  out += element("h1", "Colors of blood");
  out += "<p class=\"verdict\">" +
         page::escape("The palette is " + number(mean(fit.fitted)) + " from the table (Delta E 2000, mean), and " +
                      number(mean(fit.held_out)) + " from cells that it did not see; 1 can just be told.") +
         "</p>\n";
  out += element("p", "Table: " + table.source + ".");
  out += "<div class=\"plots\"><figure><h3>Color from the table</h3><div class=\"scroll\">" +
         swatches(table, [](const Cell& c) { return c.rgb; }) +
         "</div></figure><figure><h3>Color from the function</h3><div class=\"scroll\">" +
         swatches(table, [&](const Cell& c) { return color_of(fit.palette, c.opacity, c.time); }) +
         "</div></figure></div>\n";
  out += element("h2", "The palette") +
         "<figure><img style=\"width:100%;max-width:640px\" alt=\"Opacity to the right, time downwards\" src=\"" +
         page::png_data_url(image::png_bytes(image::display(picture_of(fit.palette, 256, 128)))) +
         "\"><figcaption>Opacity 0 to 1 to the right; time downwards from 0 to " +
         page::escape(clock_text(fit.palette.longest)) + ", by its logarithm.</figcaption></figure>\n";
  out +=
      element("h2", "How near") +
      "<div class=\"scroll\"><table><thead><tr><th>Delta E 2000</th><th>mean</th><th>largest</th></tr></thead><tbody>";
  const auto row = [](std::string_view name, const std::vector<double>& values) {
    return "<tr>" + element("td", name) + element("td", number(mean(values))) + element("td", number(largest(values))) +
           "</tr>";
  };
  out += row("spectra of haemoglobin alone", fit.spectral) + row("palette: with the spline", fit.fitted) +
         row("cells left out, a fifth in turn", fit.held_out) + "</tbody></table></div>\n";
  out += element("h2", "What was found") + "<div class=\"scroll\"><table><tbody>";
  for (std::size_t i = 0; i < Palette::kCount; ++i)
    out += "<tr>" + element("td", Palette::kParameters[i].name) +
           element("td", number(fit.palette.value[i], 4) + " " + std::string(Palette::kParameters[i].unit)) +
           element("td", Palette::kParameters[i].text) + "</tr>";
  return out + "</tbody></table></div>\n" + page::page_foot();
}

}  // namespace likeness::blood
