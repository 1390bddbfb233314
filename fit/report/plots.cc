#include "fit/report/plots.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fit/slice/slice.h"
#include "render/image/write.h"
#include "render/page/html.h"
#include "render/page/svg.h"

namespace likeness::fit {

using page::drawing;
using page::number;
using page::plain;
using page::png_data_url;
using page::svg_line;
using page::svg_text;
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kLeft = 34, kTop = 6;  // of the slice's 90 x 90 units in its drawing

std::string slice_axes() {
  std::string out =
      "<rect x=\"34\" y=\"6\" width=\"90\" height=\"90\" fill=\"none\" stroke=\"#555\" stroke-width=\".7\"/>";
  for (const int degrees : {0, 30, 60, 90}) {
    const double x = kLeft + degrees, y = kTop + 90 - degrees;
    out += svg_line(x, 96, x, 98.5, "stroke=\"#555\" stroke-width=\".7\"");
    out += svg_line(31.5, y, 34, y, "stroke=\"#555\" stroke-width=\".7\"");
    out += svg_text(x, 106, "middle", std::to_string(degrees) + "°");
    out += svg_text(30, y + 3, "end", std::to_string(degrees) + "°");
  }
  out += svg_text(79, 116, "middle",
                  "θ<tspan font-size=\"6\" dy=\"2\">h</tspan><tspan dy=\"-2\">: half vector to normal</tspan>", 7.5);
  out += svg_text(8, 51, "middle",
                  "θ<tspan font-size=\"6\" dy=\"2\">d</tspan><tspan dy=\"-2\">: half vector to light</tspan>", 7.5,
                  " transform=\"rotate(-90 8 51)\"");
  return out;
}

std::string cut_path(double cut_deg) {
  if (cut_deg >= 90) return "";
  std::string points;
  for (int i = 0; i <= 40; ++i) {
    const double theta_h = cut_deg * i / 40;
    const double cosine = std::min(1.0, std::cos(cut_deg * kDegree) / std::cos(theta_h * kDegree));
    points += number(kLeft + theta_h, 5) + "," + number(kTop + 90 - std::acos(cosine) / kDegree, 5) + " ";
  }
  const auto stroke = [&](std::string_view style) {
    return "<polyline points=\"" + points + "\" fill=\"none\" " + std::string(style) + "/>";
  };
  return stroke("stroke=\"#000\" stroke-width=\"1.3\" stroke-opacity=\".55\"") +
         stroke("stroke=\"#fff\" stroke-width=\".8\" stroke-dasharray=\"3 2\"");
}

// A frame with a logarithmic axis up, for losses.
class LossAxes {
 public:
  static constexpr double kX0 = 62, kX1 = 392, kY0 = 24, kY1 = 200;

  explicit LossAxes(const std::vector<double>& losses) {
    low_ = 1e300, high_ = 0;
    for (const double loss : losses)
      if (usable(loss)) low_ = std::min(low_, loss), high_ = std::max(high_, loss);
    if (high_ <= 0) low_ = high_ = 1;
    lowest_ = low_, highest_ = high_;
    const double room = std::max(0.06 * std::log10(high_ / low_), 0.01);
    low_ = std::log10(low_) - room, high_ = std::log10(high_) + room;
  }
  static bool usable(double loss) { return std::isfinite(loss) && loss > 0; }
  double y(double loss) const { return kY1 - (std::log10(loss) - low_) / (high_ - low_) * (kY1 - kY0); }

  std::string frame(std::string_view across, double first, double last) const {
    std::string out = "<rect x=\"62\" y=\"24\" width=\"330\" height=\"176\" fill=\"none\" stroke=\"#999\"/>";
    std::vector<double> ticks;
    const bool decades = high_ - low_ > 2;
    for (int e = static_cast<int>(std::floor(low_)); e <= static_cast<int>(std::ceil(high_)); ++e)
      for (const double m : {1.0, 2.0, 5.0}) {
        const double tick = m * std::pow(10.0, e), at = std::log10(tick);
        if (at > low_ && at < high_ && (m == 1.0 || !decades)) ticks.push_back(tick);
      }
    if (ticks.size() < 2) ticks = {lowest_, highest_};
    if (highest_ / lowest_ < 1.0001) ticks = {lowest_};
    for (const double tick : ticks) {
      out += svg_line(kX0, y(tick), kX1, y(tick), "stroke=\"#ddd\"");
      out += svg_text(kX0 - 5, y(tick) + 4, "end", highest_ / lowest_ < 1.2 ? number(tick, 5) : plain(tick), 12);
    }
    out += svg_text(kX0, kY1 + 17, "middle", plain(first), 12) + svg_text(kX1, kY1 + 17, "end", plain(last), 12);
    out += svg_text((kX0 + kX1) / 2, kY1 + 34, "middle", across, 12);
    out += svg_text(kX0, kY0 - 8, "start", "loss (log scale)", 12);
    return out;
  }

 private:
  double low_, high_;        // decades
  double lowest_, highest_;  // losses
};

}  // namespace

std::string slice_figure(const image::DisplayPicture& picture, double cut_deg, std::string_view title) {
  return drawing("0 0 132 120", title,
                 "<image class=\"pixels\" x=\"34\" y=\"6\" width=\"90\" height=\"90\" href=\"" +
                     png_data_url(image::png_bytes(picture)) + "\"/>" + cut_path(cut_deg) + slice_axes());
}

std::string regions_figure() {
  const std::string title =
      "The regions of a slice: specular peak at the left edge, Fresnel peak at the top, retroreflection at the right "
      "edge, diffuse in the middle.";
  return drawing("0 0 132 120", title,
                 "<rect x=\"34\" y=\"6\" width=\"90\" height=\"90\" fill=\"#f0ead8\"/>"
                 "<rect x=\"34\" y=\"6\" width=\"90\" height=\"20\" fill=\"#cfe0f3\"/>"
                 "<rect x=\"106\" y=\"26\" width=\"18\" height=\"70\" fill=\"#dcd3ec\"/>"
                 "<rect x=\"34\" y=\"26\" width=\"14\" height=\"70\" fill=\"#f6cfc4\"/>" +
                     svg_text(79, 19, "middle", "Fresnel peak") + svg_text(77, 64, "middle", "diffuse") +
                     svg_text(43.5, 61, "middle", "specular peak", 8, " transform=\"rotate(-90 43.5 61)\"") +
                     svg_text(118, 61, "middle", "retroreflection", 8, " transform=\"rotate(-90 118 61)\"") +
                     slice_axes());
}

std::string difference_legend() {
  std::string out = "<defs><linearGradient id=\"stops\">";
  for (int i = 0; i <= 8; ++i) {
    const Color8 c = difference_color(-kStopsRange + 2 * kStopsRange * i / 8);
    out += "<stop offset=\"" + number(i / 8.0) + "\" stop-color=\"rgb(" + std::to_string(c[0]) + "," +
           std::to_string(c[1]) + "," + std::to_string(c[2]) + ")\"/>";
  }
  out +=
      "</linearGradient><pattern id=\"hatch\" width=\"5.66\" height=\"5.66\" patternUnits=\"userSpaceOnUse\" "
      "patternTransform=\"rotate(45)\"><rect width=\"5.66\" height=\"5.66\" fill=\"#b8b8b8\"/>"
      "<rect width=\"2.83\" height=\"5.66\" fill=\"#969696\"/></pattern></defs>";
  out += "<rect x=\"20\" y=\"18\" width=\"260\" height=\"16\" fill=\"url(#stops)\" stroke=\"#777\"/>";
  for (int i = -2; i <= 2; ++i) {
    const double x = 150 + 65 * i;
    out += svg_line(x, 34, x, 39, "stroke=\"#555\"");
    out += svg_text(x, 51, "middle", i > 0 ? "+" + std::to_string(i) : i < 0 ? "−" + std::to_string(-i) : "0", 12);
  }
  out += svg_text(20, 13, "start", "model darker", 12) + svg_text(150, 13, "middle", "equal", 12) +
         svg_text(280, 13, "end", "model brighter", 12);
  out += svg_text(150, 66, "middle", "stops: +1 is twice the light, −1 is half", 12);
  out += "<rect x=\"20\" y=\"76\" width=\"22\" height=\"14\" fill=\"url(#hatch)\" stroke=\"#777\"/>" +
         svg_text(48, 87, "start", "not compared: no data, or beyond cut", 12);
  return drawing("0 0 300 94",
                 "Scale of the signed difference, from 2 stops darker (blue) over equal (white) to 2 stops "
                 "brighter (orange); hatched where nothing is compared.",
                 out);
}

std::string convergence_figure(const std::vector<Step>& steps) {
  if (steps.size() < 2) return "";
  std::vector<double> losses;
  for (const Step& step : steps) losses.push_back(step.loss);
  const LossAxes axes(losses);
  const double first = steps.front().iteration, span = std::max(1.0, steps.back().iteration - first);
  std::string points, dots;
  for (const Step& step : steps) {
    if (!LossAxes::usable(step.loss)) continue;
    const double x = LossAxes::kX0 + (step.iteration - first) / span * (LossAxes::kX1 - LossAxes::kX0);
    points += number(x, 5) + "," + number(axes.y(step.loss), 5) + " ";
    if (steps.size() <= 60)
      dots +=
          "<circle cx=\"" + number(x, 5) + "\" cy=\"" + number(axes.y(step.loss), 5) + "\" r=\"2\" fill=\"#0b5394\"/>";
  }
  return drawing("0 0 400 240",
                 "Loss against iteration of the winning start, from " + number(losses.front()) + " to " +
                     number(losses.back()) + " in " + std::to_string(steps.size()) + " evaluations.",
                 axes.frame("iteration", first, steps.back().iteration) + "<polyline points=\"" + points +
                     "\" fill=\"none\" stroke=\"#0b5394\" stroke-width=\"1.5\"/>" + dots);
}

std::string starts_figure(std::vector<double> losses) {
  if (losses.empty()) return "";
  std::sort(losses.begin(), losses.end(), [](double a, double b) {
    return LossAxes::usable(a) != LossAxes::usable(b) ? LossAxes::usable(a) : a < b;
  });
  const LossAxes axes(losses);
  const double span = std::max<double>(1, static_cast<double>(losses.size()) - 1);
  std::string dots;
  for (std::size_t i = 0; i < losses.size(); ++i) {
    if (!LossAxes::usable(losses[i])) continue;
    const double x = LossAxes::kX0 + 6 + static_cast<double>(i) / span * (LossAxes::kX1 - LossAxes::kX0 - 12);
    dots += "<circle cx=\"" + number(x, 5) + "\" cy=\"" + number(axes.y(losses[i]), 5) + "\" r=\"" +
            (i == 0 ? "5" : "3.2") + "\" fill=\"" + (i == 0 ? "#b35806" : "#0b5394") + "\"/>";
  }
  return drawing("0 0 400 240",
                 "Final loss of each of the " + std::to_string(losses.size()) + " starts, sorted; the best is " +
                     number(losses.front()) + ".",
                 axes.frame("starts, from the best to the worst", 1, static_cast<double>(losses.size())) + dots);
}

}  // namespace likeness::fit
