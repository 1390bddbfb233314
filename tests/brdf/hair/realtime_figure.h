#pragma once

#include <fstream>
#include <sstream>
#include <string>

#include "tests/brdf/hair/realtime_cases.h"

// The picture of docs/models/hair_closed.md: how the run-time forms scatter around a fibre, and how much.
namespace likeness::brdf {

// One panel: a box, ticks with numbers, and curves.
class Panel {
 public:
  Panel(double left, double top, double x0, double x1, double y0, double y1, bool logarithmic)
      : left_(left), top_(top), x0_(x0), x1_(x1), y0_(y0), y1_(y1), logarithmic_(logarithmic) {}

  static constexpr double kWide = 300, kHigh = 240;

  double x(double at) const { return left_ + kWide * (at - x0_) / (x1_ - x0_); }
  double y(double at) const {
    const auto scaled = [&](double v) { return logarithmic_ ? std::log10(std::max(v, 1e-30)) : v; };
    return top_ + kHigh * (1 - (scaled(at) - scaled(y0_)) / (scaled(y1_) - scaled(y0_)));
  }
  void text(std::ostream& out, double at_x, double at_y, const char* anchor, const std::string& words) const {
    out << "<text x=\"" << at_x << "\" y=\"" << at_y << "\" text-anchor=\"" << anchor << "\">" << words << "</text>\n";
  }
  void frame(std::ostream& out, const std::string& title, const std::string& x_name, const std::vector<double>& xs,
             const std::vector<double>& ys) const {
    out << "<rect x=\"" << left_ << "\" y=\"" << top_ << "\" width=\"" << kWide << "\" height=\"" << kHigh
        << "\" fill=\"none\" stroke=\"#999\"/>\n";
    text(out, left_, top_ - 8, "start", title);
    text(out, left_ + kWide / 2, top_ + kHigh + 32, "middle", x_name);
    const auto number = [](double v) {
      std::ostringstream words;
      words << v;
      return words.str();
    };
    for (const double v : xs) {
      out << "<path d=\"M" << x(v) << " " << top_ + kHigh << "v-4\" stroke=\"#999\"/>\n";
      text(out, x(v), top_ + kHigh + 15, "middle", number(v));
    }
    for (const double v : ys) {
      out << "<path d=\"M" << left_ << " " << y(v) << "h" << kWide << "\" stroke=\"#eee\"/>\n";
      text(out, left_ - 5, y(v) + 4, "end", number(v));
    }
  }
  // Points beyond the box are held at its edge.
  template <class F>
  void curve(std::ostream& out, F&& f, const char* style) const {
    out << "<path d=\"";
    for (int i = 0; i <= 120; ++i) {
      const double at = x0_ + (x1_ - x0_) * i / 120;
      out << (i ? "L" : "M") << x(at) << " " << std::clamp(y(f(at)), top_, top_ + kHigh) << " ";
    }
    out << "\" fill=\"none\" " << style << "/>\n";
  }

 private:
  double left_, top_, x0_, x1_, y0_, y1_;
  bool logarithmic_;
};

inline bool write_realtime_figure(const char* path) {
  constexpr const char* kStyles[]{"stroke=\"#bbb\" stroke-width=\"1.5\"",
                                  "stroke=\"#c33\" stroke-width=\"1.5\"",
                                  "stroke=\"#e90\" stroke-width=\"1.5\"",
                                  "stroke=\"#36c\" stroke-width=\"1.5\"",
                                  "stroke=\"#3a8\" stroke-width=\"1.5\" stroke-dasharray=\"2 3\"",
                                  "stroke=\"#3a8\" stroke-width=\"1.5\""};
  std::ostringstream out;
  out.precision(4);
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 760 690\" font-family=\"sans-serif\" "
         "font-size=\"11\">\n"
      << "<title>Run-time forms of hair against the far field by quadrature</title>\n"
      << "<rect width=\"760\" height=\"690\" fill=\"#fff\"/>\n";
  const auto exact = [](const RealtimeFibre& fibre, double phi, double theta_o) {
    double sum = 0;
    const double cosine = std::cos(theta_o);
    for (int p = 0; p < kHairLobes; ++p)
      sum += hair_far(p, phi, hair_width(fibre.beta_n), p ? fibre.sigma_a : 0, 1.55, cosine, 1e-6);
    return sum;
  };
  struct Around {
    double left, top, beta, theta_o;
  } constexpr kAround[]{{50, 40, 0.15, 0}, {430, 40, 0.3, 0}, {50, 350, 0.3, 60}};
  for (const Around& a : kAround) {
    const RealtimeFibre fibre{.beta_m = a.beta, .beta_n = a.beta, .sigma_a = 0.2};
    const Panel panel(a.left, a.top, 0, 180, 0.005, 1, true);
    std::ostringstream title;
    title << "scattered around [1/rad]: beta " << a.beta << ", theta_o " << a.theta_o << "°, sigma_a 0.2";
    panel.frame(out, title.str(), "phi [°]; 0 is back towards the viewer's side", {0, 45, 90, 135, 180},
                {0.01, 0.03, 0.1, 0.3, 1});
    panel.curve(
        out, [&](double phi) { return exact(fibre, phi * kHairDegree, a.theta_o * kHairDegree); },
        "stroke=\"#000\" stroke-width=\"5\" stroke-opacity=\"0.18\"");
    for (std::size_t i = 0; i < std::size(kRealtimeForms); ++i) {
      if (kRealtimeForms[i].name == "hair_lut_gauss") continue;  // its azimuths are those of hair_lut
      panel.curve(
          out,
          [&](double phi) {
            return over_inclinations(kRealtimeForms[i].eval_cos, fibre, a.theta_o * kHairDegree, phi * kHairDegree);
          },
          kStyles[i]);
    }
  }
  const Panel energy(430, 350, 0, 85, 0.2, 1.2, false);
  energy.frame(out, "energy of a white fibre, beta 0.3; the reference has 1", "theta_o [°]", {0, 20, 40, 60, 80},
               {0.2, 0.4, 0.6, 0.8, 1, 1.2});
  energy.curve(out, [](double) { return 1; }, "stroke=\"#000\" stroke-width=\"5\" stroke-opacity=\"0.18\"");
  const RealtimeFibre white{};
  for (std::size_t i = 0; i < std::size(kRealtimeForms); ++i)
    energy.curve(
        out, [&](double theta_o) { return energy_of(kRealtimeForms[i].eval_cos, white, theta_o * kHairDegree); },
        kStyles[i]);
  double x = 50;
  out << "<path d=\"M" << x << " 655h28\" stroke=\"#000\" stroke-width=\"5\" stroke-opacity=\"0.18\"/><text x=\""
      << x + 34 << "\" y=\"659\">quadrature</text>\n";
  for (std::size_t i = 0; i < std::size(kRealtimeForms); ++i) {
    x = 50 + 180 * double((i + 1) % 4);
    const int y = 655 + 20 * int((i + 1) / 4);
    out << "<path d=\"M" << x << " " << y << "h28\" " << kStyles[i] << "/><text x=\"" << x + 34 << "\" y=\"" << y + 4
        << "\">" << kRealtimeForms[i].name << "</text>\n";
  }
  out << "</svg>\n";
  return bool(std::ofstream(path) << out.str());
}

}  // namespace likeness::brdf
