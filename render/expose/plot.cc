#include "render/expose/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "brdf/lighting/zone.h"
#include "render/expose/summary.h"
#include "render/exposure/overlay.h"
#include "render/exposure/text.h"
#include "render/page/html.h"
#include "render/page/svg.h"
#include "render/view/view.h"

namespace likeness::expose {
namespace {

using brdf::Zones;

// Stops above middle grey, after exposure.
constexpr double kLow = -12, kHigh = 12, kBarsAStop = 4;
constexpr std::size_t kBars = static_cast<std::size_t>((kHigh - kLow) * kBarsAStop);
// The drawing's own units.
constexpr double kWidth = 1000, kHeight = 400, kLeft = 58, kRight = 946, kTop = 62, kBottom = 330;

double x_of(double stops) {
  return kLeft + (std::clamp(stops, kLow, kHigh) - kLow) / (kHigh - kLow) * (kRight - kLeft);
}
double y_of(double share) { return kBottom - share * (kBottom - kTop); }
double stops_of(double light) { return std::log2(std::max(light, 1e-30) / Zones::kMiddleGrey); }

std::string box(double x0, double y0, double x1, double y1, const std::string& style) {
  return "<rect x=\"" + page::number(x0, 5) + "\" y=\"" + page::number(y0, 5) + "\" width=\"" +
         page::number(std::max(x1 - x0, 0.0), 5) + "\" height=\"" + page::number(std::max(y1 - y0, 0.0), 5) + "\" " +
         style + "/>";
}

std::string css_color(const std::array<std::uint8_t, 3>& c) {
  return "rgb(" + std::to_string(c[0]) + "," + std::to_string(c[1]) + "," + std::to_string(c[2]) + ")";
}

struct Bars {
  std::array<double, kBars> share{};
  double darker = 0, brighter = 0;  // beyond the ends; darker: without black
};

Bars bars_of(const Exposed& e) {
  Bars out;
  const auto bins = e.histogram.luminance();
  const double all = static_cast<double>(std::max<std::uint64_t>(e.histogram.weight(), 1));
  for (std::size_t i = 0; i < bins.size(); ++i) {
    if (bins[i].weight == 0) continue;
    const double share = static_cast<double>(bins[i].weight) / all;
    const double stops = stops_of(exposure::Histogram::light_of(i, bins[i])) + e.view.ev;
    if (stops < kLow) out.darker += share;
    else if (stops >= kHigh) out.brighter += share;
    else out.share[std::min(static_cast<std::size_t>((stops - kLow) * kBarsAStop), kBars - 1)] += share;
  }
  return out;
}

// 1, 2 or 5 times a power of ten, so that at most five steps reach `most`.
double step_for(double most) {
  double step = std::pow(10, std::floor(std::log10(most / 5)));
  for (const double factor : {2.0, 2.5, 2.0})
    if (most / step > 5) step *= factor;
  return step;
}

std::string zones_row() {
  std::string out;
  for (int zone = 0; zone < Zones::kCount; ++zone) {
    const double stops = zone - Zones::kGreyZone;
    const auto& color = exposure::kZoneColors[static_cast<std::size_t>(zone)];
    // The ends stand for all that is darker, or brighter.
    const double from = zone == 0 ? kLow : stops - 0.5, to = zone + 1 == Zones::kCount ? kHigh : stops + 0.5;
    out += box(x_of(from), 26, x_of(to), 46, "fill=\"" + css_color(color) + "\" stroke=\"#fff\"");
    const bool is_bright = 2126 * color[0] + 7152 * color[1] + 722 * color[2] > 1100000;
    out += page::svg_text(x_of((from + to) / 2), 41, "middle", exposure::zone_numeral(zone), 13,
                          is_bright ? " style=\"fill:#000\"" : " style=\"fill:#fff\"");
  }
  return out + page::svg_text(kLeft - 6, 41, "end", "zone", 13);
}

std::string parts(const Exposed& e) {
  const double toe = e.curve.toe_end > 0 ? stops_of(e.curve.toe_end) : kLow,
               shoulder = stops_of(e.curve.shoulder_start);
  std::string out;
  if (toe > kLow) {
    out += box(kLeft, kTop, x_of(toe), kBottom, "fill=\"#296bdb\" fill-opacity=\"0.10\"");
    out += page::svg_text((kLeft + x_of(toe)) / 2, kTop + 14, "middle",
                          "toe " + percent_text(e.chosen().shares.toe) + " %", 13);
  }
  if (shoulder < kHigh) {
    out += box(x_of(shoulder), kTop, kRight, kBottom, "fill=\"#f28c1a\" fill-opacity=\"0.13\"");
    out += page::svg_text((kRight + x_of(shoulder)) / 2, kTop + 14, "middle",
                          "shoulder " + percent_text(e.chosen().shares.shoulder) + " %", 13);
  }
  const double middle = (x_of(toe) + x_of(shoulder)) / 2;
  out += page::svg_text(middle, 16, "middle", "linear part " + percent_text(e.chosen().shares.linear) + " %", 13,
                        " font-weight=\"600\"");
  out += box(x_of(toe), 20, x_of(shoulder), 23, "fill=\"#1c1f23\"");
  return out;
}

// Where codes end, as dashed lines; left out where they are beyond the drawing.
std::string ends(const Exposed& e) {
  constexpr auto kDashes = "stroke=\"#1c1f23\" stroke-dasharray=\"3 4\"";
  std::string out;
  const double dark = e.curve.crushed_below > 0 ? stops_of(e.curve.crushed_below) : kLow,
               full = stops_of(e.curve.clipped_from);
  if (dark > kLow) {
    out += page::svg_line(x_of(dark), kTop, x_of(dark), kBottom, kDashes);
    out += page::svg_text(x_of(dark) + 4, kTop + 34, "start", "code 0 left of here", 12);
  }
  if (full < kHigh) {
    out += page::svg_line(x_of(full), kTop, x_of(full), kBottom, kDashes);
    out += page::svg_text(x_of(full) + 4, kTop + 34, "start", "code 255 right of here", 12);
  }
  return out;
}

std::string curve_line(const Exposed& e) {
  scene::View view = e.view;
  view.ev = 0;
  const view::Shower shower(view);
  constexpr int kSteps = 240;
  std::vector<float> light;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = Zones::kMiddleGrey * std::exp2(kLow + (kHigh - kLow) * i / kSteps);
    light.insert(light.end(), 3, static_cast<float>(x));
  }
  shower.encode(light);
  std::string points;
  for (int i = 0; i <= kSteps; ++i) {
    const auto at = 3 * static_cast<std::size_t>(i) + 1;
    points += (i == 0 ? "" : " ") + page::number(x_of(kLow + (kHigh - kLow) * i / kSteps), 5) + "," +
              page::number(y_of(static_cast<double>(light[at])), 5);
  }
  return "<polyline points=\"" + points + "\" fill=\"none\" stroke=\"#b0303a\" stroke-width=\"2.5\"/>";
}

std::string axes(double most, double step) {
  std::string out = box(kLeft, kTop, kRight, kBottom, "fill=\"none\" stroke=\"#8a919b\"");
  for (int stops = static_cast<int>(kLow); stops <= static_cast<int>(kHigh); stops += 2) {
    out += page::svg_line(x_of(stops), kBottom, x_of(stops), kBottom + 5, "stroke=\"#8a919b\"");
    out += page::svg_text(x_of(stops), kBottom + 20, "middle",
                          stops > 0   ? "+" + std::to_string(stops)
                          : stops < 0 ? "−" + std::to_string(-stops)
                                      : "0",
                          13);
  }
  out += page::svg_text((kLeft + kRight) / 2, kBottom + 42, "middle",
                        "stops above middle grey (0.18), after exposure: luminance of bars, light of the curve", 13);
  for (double share = step; share <= most * 1.0001; share += step)
    out += page::svg_text(kLeft - 6, y_of(0.8 * share / most) + 4, "end", page::plain(100 * share) + " %", 12) +
           page::svg_line(kLeft, y_of(0.8 * share / most), kLeft + 5, y_of(0.8 * share / most), "stroke=\"#8a919b\"");
  for (const int code : {0, 64, 128, 192, 255})
    out += page::svg_text(kRight + 6, y_of(code / 255.0) + 4, "start", std::to_string(code), 12,
                          " style=\"fill:#b0303a\"");
  out += page::svg_text(kRight + 6, kTop - 10, "start", "code", 12, " style=\"fill:#b0303a\"");
  return out;
}

}  // namespace

std::string plot_of(const Exposed& e) {
  const Bars bars = bars_of(e);
  const double most = std::max(*std::max_element(bars.share.begin(), bars.share.end()), 1e-6), step = step_for(most);
  std::string content = zones_row() + parts(e);
  for (std::size_t i = 0; i < kBars; ++i) {
    if (bars.share[i] == 0) continue;
    const double from = kLow + static_cast<double>(i) / kBarsAStop;
    content += box(x_of(from), std::min(y_of(0.8 * bars.share[i] / most), kBottom - 0.5), x_of(from + 1 / kBarsAStop),
                   kBottom, "fill=\"#6b7684\" stroke=\"#fff\" stroke-width=\"0.5\"");
  }
  content += axes(most, step) + ends(e) + curve_line(e);
  if (bars.darker > 0)
    content += page::svg_text(kLeft + 6, kBottom - 8, "start", "← " + percent_text(bars.darker) + " % darker", 12);
  if (bars.brighter > 0)
    content += page::svg_text(kRight - 6, kBottom - 8, "end", percent_text(bars.brighter) + " % brighter →", 12);
  return page::drawing("0 0 " + page::plain(kWidth) + " " + page::plain(kHeight),
                       "Histogram of luminance in stops after exposure, under the curve of the view", content);
}

}  // namespace likeness::expose
