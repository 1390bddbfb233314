#include "brdf/cost/pareto_figure.h"

#include <algorithm>
#include <cmath>

#include "render/page/html.h"
#include "render/page/svg.h"

namespace likeness::cost {
namespace {

using page::number;
using page::svg_line;
using page::svg_text;

constexpr double kLeft = 46, kRight = 340, kTop = 22, kBottom = 238;
constexpr double kLeastError = 1e-8;  // smaller ones stand on the lowest line: a float cannot tell them apart

// Decades that hold all values of a family, so that its three plots share their axes.
struct Span {
  double low, high;
  double at(double value, double from, double to) const {
    return from + (std::log10(value) - low) / (high - low) * (to - from);
  }
};

template <class F>
Span span_of(const FamilyResult& result, F&& value) {
  double least = 1e300, most = 0;
  for (const auto& cells : result.cells)
    for (const Cell& cell : cells) {
      least = std::min(least, value(cell));
      most = std::max(most, value(cell));
    }
  return {std::floor(std::log10(least) - 0.1), std::ceil(std::log10(most) + 0.1)};
}

double error_of(const Cell& cell) { return std::max(cell.accuracy.rms, kLeastError); }
double time_of(const Cell& cell) { return std::max(cell.timing.ns, 0.01); }

std::string power_of_ten(int e) {
  if (e >= 0 && e <= 3) return number(std::pow(10.0, e), e + 1);
  if (e == -1) return "0.1";
  if (e == -2) return "0.01";
  return "10<tspan font-size=\"8\" dy=\"-4\">" + std::string(e < 0 ? "−" : "") + std::to_string(std::abs(e)) +
         "</tspan>";
}

std::string frame(const Span& x, const Span& y, bool has_floor) {
  std::string out;
  const int x_step = x.high - x.low > 6 ? 2 : 1, y_step = y.high - y.low > 6 ? 2 : 1;
  for (int e = int(x.low); e <= int(x.high); ++e) {
    const double at = x.at(std::pow(10.0, e), kLeft, kRight);
    out += svg_line(at, kTop, at, kBottom, "stroke=\"#e3e3e3\"");
    if ((e - int(x.low)) % x_step == 0) out += svg_text(at, kBottom + 14, "middle", power_of_ten(e), 11);
  }
  for (int e = int(y.low); e <= int(y.high); ++e) {
    const double at = y.at(std::pow(10.0, e), kBottom, kTop);
    out += svg_line(kLeft, at, kRight, at, "stroke=\"#e3e3e3\"");
    const bool is_floor = has_floor && e == int(y.low);
    if ((e - int(y.low)) % y_step == 0)
      out += svg_text(kLeft - 5, at + 4, "end", (is_floor ? "≤ " : "") + power_of_ten(e), 11);
  }
  return out + "<rect x=\"" + number(kLeft) + "\" y=\"" + number(kTop) + "\" width=\"" + number(kRight - kLeft) +
         "\" height=\"" + number(kBottom - kTop) + "\" fill=\"none\" stroke=\"#888\"/>" +
         svg_text((kLeft + kRight) / 2, kBottom + 31, "middle", "ns per evaluation →", 11) +
         svg_text(kLeft, kTop - 8, "start", "relative RMS error ↓ better", 11);
}

}  // namespace

std::string pareto_figure(const FamilyResult& result, Precision precision) {
  const Span x = span_of(result, time_of);
  Span y = span_of(result, error_of);
  const bool has_floor = y.low <= std::log10(kLeastError);
  if (has_floor) y.low = std::log10(kLeastError);
  const std::size_t p = std::size_t(precision);

  struct Point {
    std::size_t rung;
    double time, error;
    bool dominated;
  };
  std::vector<Point> points;
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    const Cell& cell = result.cells[i][p];
    points.push_back({i, time_of(cell), error_of(cell), !cell.dominated_by.empty()});
  }
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.time < b.time; });

  std::string front, discs;
  double level = -1;
  for (const Point& point : points) {
    if (point.dominated) continue;
    const double px = x.at(point.time, kLeft, kRight), py = y.at(point.error, kBottom, kTop);
    if (level >= 0) front += number(px, 5) + "," + number(level, 5) + " ";
    front += number(px, 5) + "," + number(py, 5) + " ";
    level = py;
  }
  // The dominated first, so that the front lies over them.
  std::stable_sort(points.begin(), points.end(),
                   [](const Point& a, const Point& b) { return a.dominated > b.dominated; });
  for (const Point& point : points) {
    const double px = x.at(point.time, kLeft, kRight), py = y.at(point.error, kBottom, kTop);
    const std::string label = std::to_string(point.rung + 1);
    discs += "<g><title>" + page::escape(result.family.rungs[point.rung].label) + ": " + number(point.time) +
             " ns, error " + number(point.error) + (point.dominated ? ", dominated" : "") + "</title><circle cx=\"" +
             number(px, 5) + "\" cy=\"" + number(py, 5) + "\" r=\"8\" fill=\"" +
             (point.dominated ? "#fff" : "#0b5394") + "\" stroke=\"" + (point.dominated ? "#777" : "#0b5394") + "\"" +
             (point.dominated ? " stroke-dasharray=\"2 2\"" : "") + "/>" +
             svg_text(px, py + 3.8, "middle", label, 10.5,
                      point.dominated ? " style=\"fill:#555\"" : " style=\"fill:#fff;font-weight:700\"") +
             "</g>";
  }
  const std::string title = result.family.title + " in " + std::string(kPrecisionNames[p]) +
                            ": error against time; the numbers are those of the table.";
  return page::drawing("0 0 360 276", title,
                       frame(x, y, has_floor) + "<polyline points=\"" + front +
                           "\" fill=\"none\" stroke=\"#0b5394\" stroke-width=\"1.4\" stroke-opacity=\".6\"/>" + discs +
                           svg_text(kRight, kTop - 8, "end", kPrecisionNames[p], 13, " style=\"font-weight:700\""));
}

}  // namespace likeness::cost
