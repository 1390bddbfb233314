#pragma once

#include <string>
#include <utility>
#include <vector>

// The axes of a plot of error against time.
namespace likeness::page {

// A logarithmic axis for values above 0 that lie in a cluster, with a few far from it: those stand behind a break, in a
// strip of its own scale.
struct Axis {
  double low = 0, high = 1;  // decades of the cluster's part
  double from = 0, to = 1;   // where low and high are drawn
  bool is_broken = false, strip_is_low = false;
  double strip_low = 0, strip_high = 0;  // decades
  double strip_from = 0, strip_to = 0;   // where they are drawn

  // The values beyond the break.
  bool in_strip(double value) const;
  double at(double value) const;
  // Of the cluster's part: whole decades, with 2 and 5 if it spans few, with more if it spans less than one.
  std::vector<std::pair<double, double>> ticks() const;  // value, place
};

// `values` are above 0. Splits where two neighbours are more than `gap` decades apart, first met from the kept end:
// the smallest times (`strip_is_low` false) or the largest errors. `pad`: decades left free at both ends.
Axis axis_over(std::vector<double> values, bool strip_is_low, double gap, double pad, double from, double to,
               double strip_size);

}  // namespace likeness::page
