#pragma once

#include <array>
#include <string>
#include <vector>

// Curves over one quantity, as inline SVG.
namespace likeness::page {

struct PlotLine {
  std::string name;                           // in the legend; empty: not there
  std::vector<std::array<double, 2>> points;  // what is not finite breaks the line
  std::string color = "#0b5394";
  std::string dash{};  // as SVG has it, "5 3"; empty: a whole line
  double width = 1.6;
};

struct PlotDot {
  std::array<double, 2> at{};
  double error = 0;  // half the length of a bar up and down; 0: none
  std::string color = "#1c1f23";
  std::string label{};  // said where the pointer is
  double radius = 3;
};

struct PlotBand {
  double from = 0, to = 0;  // across
  std::string name{};
  std::string color = "#f3d9b1";
};

struct PlotAxis {
  std::string name;
  double low = 0, high = 1;  // above 0 if logarithmic
  bool is_log = false;
};

// Texts are plain; they are escaped here. What lies outside the axes is cut off.
struct LinePlot {
  std::string title;  // for who does not see it
  PlotAxis across, up;
  std::vector<PlotLine> lines{};
  std::vector<PlotDot> dots{};
  std::string dots_name{};
  std::vector<PlotBand> bands{};
};

std::string drawing_of(const LinePlot& plot);

// Steps of 1, 2 or 5 times a power of ten within [low, high], about `count` of them.
std::vector<double> round_steps(double low, double high, int count);

}  // namespace likeness::page
