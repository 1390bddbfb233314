#include "render/page/pareto_plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/page/html.h"
#include "render/page/pareto_axis.h"
#include "render/page/svg.h"

namespace likeness::page {
namespace {

constexpr double kWidth = 580, kHeight = 372;
constexpr double kLeft = 58, kRight = 568, kTop = 34, kBottom = 322;
constexpr double kDisc = 6, kLine = 13;
constexpr double kLabelSize = 11.5, kLetter = 6.2, kBoldLetter = 7;  // of labels; an average

struct Box {
  double x0, y0, x1, y1;
  double overlap(const Box& b) const {
    const double w = std::min(x1, b.x1) - std::max(x0, b.x0), h = std::min(y1, b.y1) - std::max(y0, b.y0);
    return w > 0 && h > 0 ? w * h : 0;
  }
};

struct Point {
  const ParetoPoint* source;
  double time, error;  // as drawn
  double x = 0, y = 0;
  std::string numbers = {};  // where an axis does not tell them

  bool in_front() const { return source->mark == ParetoMark::kDisc && !source->is_dominated; }
};

std::string error_text(double error, double least) {
  if (error <= least) return "0";
  return number(error, error >= 1e-3 ? 2 : 1);
}

// The letters of a label, not its bytes.
double width_of(const std::string& text, bool bold) {
  return (bold ? kBoldLetter : kLetter) *
         double(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

// Where each label lies: beside its point, or, where others are in the way, farther off with a line to it.
class Labels {
 public:
  Labels(const std::vector<Point>& points, std::vector<Box> taken) : taken_(std::move(taken)) {
    for (const Point& p : points)
      taken_.push_back({p.x - kDisc - 1, p.y - kDisc - 1, p.x + kDisc + 1, p.y + kDisc + 1});
  }
  // The first label of the point that has room, nearest to it; empty if none has.
  std::string place(const Point& p) {
    for (const std::string& label : p.source->labels)
      if (const std::string out = place(p, label + p.numbers); !out.empty()) return out;
    return "";
  }

 private:
  std::string place(const Point& p, const std::string& label) {
    const bool in_front = p.in_front();
    const double width = width_of(label, in_front);
    struct Candidate {
      double dx, dy;  // from the point to the near end of the text, or to its middle
      int side;       // 1 to the right, -1 to the left, 0 above or below
    };
    std::vector<Candidate> all;
    for (const double dy : {0.0, -10.0, 10.0, -20.0, 20.0, -32.0, 32.0, -45.0, 45.0, -60.0, 60.0, -76.0, 76.0, -92.0}) {
      const double dx = dy == 0 ? kDisc + 4 : kDisc + 2;
      all.push_back({dx, dy, 1});
      all.push_back({-dx, dy, -1});
      if (std::abs(dy) >= 20) all.push_back({0, dy, 0});
    }
    const Candidate* best = nullptr;
    for (const Candidate& c : all) {
      const double x = p.x + c.dx - (c.side < 0 ? width : c.side == 0 ? width / 2 : 0), y = p.y + c.dy;
      const Box box{x - 1, y - kLine / 2, x + width + 1, y + kLine / 2};
      const Box inside{kLeft + 2, kTop + 2, kRight - 2, kBottom - 2};
      if ((box.x1 - box.x0) * (box.y1 - box.y0) - box.overlap(inside) > 1e-9) continue;
      if (std::any_of(taken_.begin(), taken_.end(), [&](const Box& other) { return other.overlap(box) > 0; })) continue;
      best = &c;
      taken_.push_back(box);
      break;
    }
    if (best == nullptr) return "";
    const double anchor = p.x + best->dx;
    std::string out;
    if (std::abs(best->dy) > 15)
      out += svg_line(p.x, p.y, anchor, p.y + best->dy * 0.8, "stroke=\"#999\" stroke-width=\".8\"");
    const std::string style = in_front                                 ? "fill:#0b3d6e;font-weight:600"
                              : p.source->mark == ParetoMark::kDiamond ? "fill:#7a3b00"
                                                                       : "fill:#595959";
    return out + svg_text(anchor, p.y + best->dy + 4,
                          best->side > 0   ? "start"
                          : best->side < 0 ? "end"
                                           : "middle",
                          escape(label), kLabelSize,
                          " style=\"" + style + ";paint-order:stroke;stroke:#fff;stroke-width:3px\"");
  }

  std::vector<Box> taken_;
};

std::string tick_text(double value) { return value >= 1e6 || value < 1e-4 ? number(value, 1) : plain(value); }

// Two short strokes across the frame, where an axis is broken.
std::string break_mark(double x, double y, bool across_x) {
  std::string out;
  for (const double d : {-2.5, 2.5}) {
    const double ux = across_x ? d : 0, uy = across_x ? 0 : d;
    out += svg_line(x + ux - 4, y + uy + 4, x + ux + 4, y + uy - 4, "stroke=\"#555\"");
  }
  return out;
}

std::string frame(const ParetoPlot& plot, const Axis& x, const Axis& y) {
  std::string out = "<rect x=\"" + number(kLeft) + "\" y=\"" + number(kTop) + "\" width=\"" + number(kRight - kLeft) +
                    "\" height=\"" + number(kBottom - kTop) + "\" fill=\"#fff\" stroke=\"#888\"/>";
  for (const auto& [value, at] : x.ticks())
    out += svg_line(at, kTop, at, kBottom, "stroke=\"#e6e6e6\"") +
           svg_text(at, kBottom + 15, "middle", tick_text(value), 11);
  for (const auto& [value, at] : y.ticks())
    out += svg_line(kLeft, at, kRight, at, "stroke=\"#e6e6e6\"") +
           svg_text(kLeft - 5, at + 4, "end", tick_text(value), 11);
  if (x.is_broken) {
    out += svg_line(x.to, kTop, x.to, kBottom, "stroke=\"#888\" stroke-dasharray=\"4 3\"") +
           break_mark(x.to, kBottom, true) + svg_text((x.to + kRight) / 2, kBottom + 15, "middle", "slower →", 11);
  }
  if (y.is_broken) {
    out += svg_line(kLeft, y.from, kRight, y.from, "stroke=\"#888\" stroke-dasharray=\"4 3\"") +
           break_mark(kLeft, y.from, false) + svg_text(kLeft - 5, (y.from + kBottom) / 2 + 4, "end", "below", 11);
  }
  return out +
         svg_text((kLeft + (x.is_broken ? x.to : kRight)) / 2, kBottom + 33, "middle", escape(plot.time_axis), 12) +
         svg_text(kLeft, kTop - 9, "start", escape(plot.error_axis), 12);
}

std::vector<Point> points_of(const ParetoPlot& plot) {
  std::vector<Point> points;
  for (const ParetoPoint& p : plot.points)
    points.push_back({&p, std::max(p.time, plot.least_time), std::max({p.error, plot.noise, plot.least_error})});
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.time < b.time; });
  return points;
}

// A step line down along the points that are not dominated, which stand in the order of their times.
std::string front_of(const std::vector<Point>& points) {
  std::string front;
  double level = -1;
  for (const Point& point : points) {
    if (!point.in_front() || point.y <= level) continue;
    if (level >= 0) front += number(point.x, 5) + "," + number(level, 5) + " ";
    front += number(point.x, 5) + "," + number(point.y, 5) + " ";
    level = point.y;
  }
  return "<polyline points=\"" + front +
         "\" fill=\"none\" stroke=\"#0b5394\" stroke-width=\"1.6\" stroke-opacity=\".5\"/>";
}

// From one to the next of those of another kind.
std::string line_of_diamonds(const std::vector<Point>& points) {
  std::string line;
  for (const Point& p : points)
    if (p.source->mark == ParetoMark::kDiamond) line += number(p.x, 5) + "," + number(p.y, 5) + " ";
  if (line.empty()) return "";
  return "<polyline points=\"" + line +
         "\" fill=\"none\" stroke=\"#b35806\" stroke-width=\"1.2\" stroke-dasharray=\"5 3\"/>";
}

std::string mark_of(const Point& p) {
  const ParetoMark mark = p.source->mark;
  if (mark == ParetoMark::kDiamond)
    return "<path d=\"M" + number(p.x, 5) + " " + number(p.y - kDisc, 5) + "l" + number(kDisc) + " " + number(kDisc) +
           "l-" + number(kDisc) + " " + number(kDisc) + "l-" + number(kDisc) + " -" + number(kDisc) +
           "z\" fill=\"#b35806\" stroke=\"#fff\"/>";
  const std::string style = !p.in_front() ? "fill=\"#fff\" stroke=\"#777\" stroke-width=\"1.5\""
                                          : "fill=\"#0b5394\" stroke=\"#fff\" stroke-width=\"1\"";
  if (mark == ParetoMark::kSquare)
    return "<rect x=\"" + number(p.x - kDisc + 1, 5) + "\" y=\"" + number(p.y - kDisc + 1, 5) + "\" width=\"" +
           number(2 * kDisc - 2) + "\" height=\"" + number(2 * kDisc - 2) + "\" " + style + "/>";
  return "<circle cx=\"" + number(p.x, 5) + "\" cy=\"" + number(p.y, 5) + "\" r=\"" + number(kDisc) + "\" " + style +
         "/>";
}

std::string noise_of(const ParetoPlot& plot, const Axis& y) {
  if (!(plot.noise > 0) || y.in_strip(plot.noise)) return "";
  const double at = y.at(plot.noise);
  return "<rect x=\"" + number(kLeft) + "\" y=\"" + number(at, 5) + "\" width=\"" + number(kRight - kLeft) +
         "\" height=\"" + number(kBottom - at, 5) + "\" fill=\"#b35806\" fill-opacity=\".12\"/>" +
         svg_text(kLeft + 6, kBottom - 6, "start", "below the noise of the reference", 11);
}

// Who is labelled first: the front, then what is for comparison, then the rest; and in each of them the point that is
// farthest from those before it, so that labels spread over the plot.
std::vector<const Point*> by_claim(const std::vector<Point>& points) {
  const auto rank = [](const Point& p) { return p.in_front() ? 0 : p.source->mark == ParetoMark::kDiamond ? 1 : 2; };
  std::vector<const Point*> out;
  for (int k = 0; k < 3; ++k) {
    std::vector<const Point*> left;
    for (const Point& p : points)
      if (rank(p) == k) left.push_back(&p);
    while (!left.empty()) {
      const auto nearest = [&](const Point* p) {
        double least = HUGE_VAL;
        for (const Point* other : out) least = std::min(least, std::hypot(p->x - other->x, p->y - other->y));
        return least;
      };
      const auto next = std::max_element(left.begin(), left.end(),
                                         [&](const Point* a, const Point* b) { return nearest(a) < nearest(b); });
      out.push_back(*next);
      left.erase(next);
    }
  }
  return out;
}

}  // namespace

std::string drawing_of(const ParetoPlot& plot) {
  std::vector<Point> points = points_of(plot);
  std::vector<double> times, errors;
  for (const Point& point : points) times.push_back(point.time), errors.push_back(point.error);
  for (const double error : plot.other_errors) errors.push_back(std::max({error, plot.noise, plot.least_error}));
  for (const ParetoLevel& level : plot.levels) errors.push_back(std::max(level.error, plot.least_error));
  if (plot.noise > 0) errors.push_back(0.7 * plot.noise);  // room for the band
  // The more stand in the strip of the slow, the wider it is.
  const Axis probe = axis_over(times, false, 1.1, 0.12, kLeft, kRight, 0);
  const double slow = double(std::count_if(times.begin(), times.end(), [&](double t) { return probe.in_strip(t); }));
  const Axis x = axis_over(times, false, 1.1, 0.12, kLeft, kRight, std::min(190.0, 60 + 34 * slow));
  const Axis y = axis_over(errors, true, 1.5, 0.12, kBottom, kTop, slow > 2 ? 110 : 56);

  for (Point& point : points) {
    point.x = x.at(point.time), point.y = y.at(point.error);
    std::string numbers;
    if (y.in_strip(point.error)) numbers = error_text(point.error, plot.least_error);
    if (x.in_strip(point.time)) numbers += (numbers.empty() ? "" : ", ") + plot.time_text(point.time);
    if (!numbers.empty()) point.numbers = " (" + numbers + ")";
  }
  std::string content = frame(plot, x, y) + noise_of(plot, y);
  std::vector<Box> taken;
  for (const ParetoLevel& level : plot.levels) {
    const double at = y.at(std::max(level.error, plot.least_error));
    content += svg_line(kLeft, at, kRight, at, "stroke=\"#2d7d46\" stroke-dasharray=\"7 4\"") +
               svg_text(kLeft + 6, at + 12, "start", escape(level.name), 11, " style=\"fill:#1d5a31\"");
    taken.push_back({kLeft, at, kLeft + 12 + width_of(level.name, false), at + 15});
  }
  content += front_of(points) + (plot.joins_diamonds ? line_of_diamonds(points) : "");
  Labels labels(points, std::move(taken));
  std::string marks, names;
  for (const Point* point : by_claim(points)) names += labels.place(*point);
  for (const Point& point : points)
    marks += "<g><title>" + escape(point.source->name) + ": " + escape(plot.time_text(point.time)) + ", error " +
             error_text(point.error, plot.least_error) + (point.source->is_dominated ? ", dominated" : "") +
             escape(point.source->remark) + "</title>" + mark_of(point) + "</g>";
  return drawing("0 0 " + number(kWidth) + " " + number(kHeight), plot.title,
                 content + names + marks +
                     svg_text(kRight, kTop - 9, "end", escape(plot.corner), 13, " style=\"font-weight:700\""));
}

}  // namespace likeness::page
