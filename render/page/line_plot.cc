#include "render/page/line_plot.h"

#include <algorithm>
#include <cmath>

#include "render/page/html.h"
#include "render/page/svg.h"

namespace likeness::page {
namespace {

constexpr double kPlotLeft = 64, kPlotRight = 470, kPlotTop = 14, kPlotBottom = 250, kPlotText = 11.5;

struct PlotScale {
  const PlotAxis& axis;
  double from, to;  // where low and high are drawn

  double at(double value) const {
    const double low = axis.is_log ? std::log10(axis.low) : axis.low;
    const double high = axis.is_log ? std::log10(axis.high) : axis.high;
    return from + ((axis.is_log ? std::log10(value) : value) - low) / (high - low) * (to - from);
  }
  std::vector<double> ticks() const {
    if (!axis.is_log) return round_steps(axis.low, axis.high, 6);
    std::vector<double> out;
    const int first = static_cast<int>(std::floor(std::log10(axis.low))),
              last = static_cast<int>(std::ceil(std::log10(axis.high)));
    const int step = std::max(1, (last - first) / 7);
    for (int e = first; e <= last; e += step) {
      for (const double m : {1.0, 2.0, 5.0}) {
        if (m > 1 && last - first > 3) break;
        if (const double tick = m * std::pow(10.0, e); tick >= axis.low * 0.999 && tick <= axis.high * 1.001)
          out.push_back(tick);
      }
    }
    return out;
  }
};

std::string points_text(const std::vector<std::array<double, 2>>& points, const PlotScale& x, const PlotScale& y) {
  std::string path;
  bool is_open = false;
  for (const auto& point : points) {
    const double px = x.at(point[0]), py = y.at(point[1]);
    if (!std::isfinite(px) || !std::isfinite(py)) {
      is_open = false;
      continue;
    }
    // Far outside the frame a coordinate needs no more digits than its direction.
    path += (is_open ? " L" : " M") + number(std::clamp(px, -1e4, 1e4), 6) + " " + number(std::clamp(py, -1e4, 1e4), 6);
    is_open = true;
  }
  return path;
}

std::string frame_of(const PlotScale& x, const PlotScale& y) {
  std::string out;
  for (const double tick : x.ticks()) {
    out += svg_line(x.at(tick), kPlotTop, x.at(tick), kPlotBottom, "stroke=\"#e4e6ea\"");
    out += svg_text(x.at(tick), kPlotBottom + 15, "middle", plain(tick), kPlotText);
  }
  for (const double tick : y.ticks()) {
    out += svg_line(kPlotLeft, y.at(tick), kPlotRight, y.at(tick), "stroke=\"#e4e6ea\"");
    out += svg_text(kPlotLeft - 5, y.at(tick) + 4, "end", plain(tick), kPlotText);
  }
  out += svg_text((kPlotLeft + kPlotRight) / 2, kPlotBottom + 33, "middle", escape(x.axis.name), kPlotText);
  out += svg_text(13, (kPlotTop + kPlotBottom) / 2, "middle", escape(y.axis.name), kPlotText,
                  " transform=\"rotate(-90 13 " + number((kPlotTop + kPlotBottom) / 2, 5) + ")\"");
  return out;
}

}  // namespace

std::vector<double> round_steps(double low, double high, int count) {
  const double span = high - low;
  if (!(span > 0) || !std::isfinite(span) || count < 1) return {};
  const double rough = span / count, power = std::pow(10.0, std::floor(std::log10(rough)));
  const double step = power * (rough / power < 1.5 ? 1 : rough / power < 3.5 ? 2 : rough / power < 7.5 ? 5 : 10);
  std::vector<double> out;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * span && out.size() < 100; ++k)
    out.push_back(k == 0 ? 0 : k * step);
  return out;
}

std::string drawing_of(const LinePlot& plot) {
  const PlotScale x{plot.across, kPlotLeft, kPlotRight}, y{plot.up, kPlotBottom, kPlotTop};
  // One name for the clip path of each drawing of a page: the title tells them apart.
  std::string id = "plot";
  for (const char c : plot.title)
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) id += c;
  std::string bands, curves, legend;
  double row = kPlotBottom + 54;
  const auto legend_row = [&](const std::string& mark, const std::string& name) {
    legend += mark + svg_text(kPlotLeft + 34, row + 4, "start", escape(name), kPlotText);
    row += 17;
  };
  for (const PlotBand& band : plot.bands) {
    const double from = std::clamp(x.at(band.from), kPlotLeft, kPlotRight),
                 to = std::clamp(x.at(band.to), kPlotLeft, kPlotRight);
    const std::string rest = "\" fill=\"" + band.color + "\"/>";
    bands += "<rect x=\"" + number(from, 5) + "\" y=\"14\" width=\"" + number(std::max(0.5, to - from), 5) +
             "\" height=\"236" + rest;
    if (!band.name.empty())
      legend_row(
          "<rect x=\"" + number(kPlotLeft, 4) + "\" y=\"" + number(row - 6, 5) + "\" width=\"26\" height=\"11" + rest,
          band.name);
  }
  for (const PlotLine& line : plot.lines) {
    const std::string style = "fill=\"none\" stroke=\"" + line.color + "\" stroke-width=\"" + number(line.width) +
                              "\"" + (line.dash.empty() ? "" : " stroke-dasharray=\"" + line.dash + "\"");
    curves += "<path d=\"" + points_text(line.points, x, y) + "\" " + style + "/>";
    if (!line.name.empty()) legend_row(svg_line(kPlotLeft, row, kPlotLeft + 26, row, style), line.name);
  }
  for (const PlotDot& dot : plot.dots) {
    const double px = x.at(dot.at[0]), py = y.at(dot.at[1]);
    if (!std::isfinite(px) || !std::isfinite(py)) continue;
    if (dot.error > 0)
      curves += svg_line(px, std::clamp(y.at(dot.at[1] - dot.error), -1e4, 1e4), px,
                         std::clamp(y.at(dot.at[1] + dot.error), -1e4, 1e4), "stroke=\"" + dot.color + "\"");
    curves += "<circle cx=\"" + number(px, 5) + "\" cy=\"" + number(py, 5) + "\" r=\"" + number(dot.radius) +
              "\" fill=\"" + dot.color + "\">" + (dot.label.empty() ? "" : element("title", dot.label)) + "</circle>";
  }
  if (!plot.dots_name.empty() && !plot.dots.empty())
    legend_row("<circle cx=\"" + number(kPlotLeft + 13, 5) + "\" cy=\"" + number(row, 5) + "\" r=\"3\" fill=\"" +
                   plot.dots.front().color + "\"/>",
               plot.dots_name);
  const std::string frame = "x=\"64\" y=\"14\" width=\"406\" height=\"236\"";
  return drawing("0 0 480 " + number(row, 5), plot.title,
                 "<clipPath id=\"" + id + "\"><rect " + frame + "/></clipPath>" + bands + frame_of(x, y) +
                     "<g clip-path=\"url(#" + id + ")\">" + curves + "</g><rect " + frame +
                     " fill=\"none\" stroke=\"#999\"/>" + legend);
}

}  // namespace likeness::page
