#pragma once

#include <functional>
#include <string>
#include <vector>

// Error against time, both logarithmic, as inline SVG: which of several ways to compute a thing is worth its time.
namespace likeness::page {

enum class ParetoMark {
  kDisc,    // a way among others; hollow and grey where another is at once faster and no less exact
  kSquare,  // one that is not compared: hollow, and never on the front
  kDiamond  // one of another kind, for comparison
};

struct ParetoPoint {
  std::string name;
  double time = 0, error = 0;  // above 0; smaller ones are drawn as least_time and least_error
  ParetoMark mark = ParetoMark::kDisc;
  bool is_dominated = false;
  // What may be written beside it: the first that has room; nothing if none has. Its name is said where the pointer is.
  std::vector<std::string> labels = {};
  std::string remark = {};  // said there after name, time and error
};

struct ParetoLevel {
  double error = 0;
  std::string name;
};

// Texts are plain; they are escaped here.
struct ParetoPlot {
  std::string title;   // for who does not see it
  std::string corner;  // at the top right
  std::string time_axis, error_axis;
  std::vector<ParetoPoint> points;
  std::vector<double> other_errors = {};  // of other plots that share the error's axis
  double noise = 0;                       // below it errors mean nothing: a band. 0: none
  std::vector<ParetoLevel> levels = {};   // lines across
  double least_time = 0.01, least_error = 1e-12;
  bool joins_diamonds = false;  // they are one way with more and more effort: a line from one to the next
  std::function<std::string(double)> time_text;
};

// The front is a line. Points far from the others stand behind a break of the axis with their numbers written out.
std::string drawing_of(const ParetoPlot& plot);

}  // namespace likeness::page
