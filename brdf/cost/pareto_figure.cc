#include "brdf/cost/pareto_figure.h"

#include "render/page/html.h"
#include "render/page/pareto_plot.h"

namespace likeness::cost {
namespace {

std::string time_text(double ns) {
  using page::number;
  return ns < 1e3 ? number(ns) + " ns" : ns < 1e6 ? number(ns / 1e3) + " µs" : number(ns / 1e6) + " ms";
}

}  // namespace

std::string pareto_figure(const FamilyResult& result, Precision precision) {
  const std::size_t p = std::size_t(precision);
  const std::string precision_name = std::string(kPrecisionNames[p]) + (p == 2 ? " of floats" : "");
  page::ParetoPlot plot;
  plot.title = result.family.title + ", " + precision_name + ": error against time.";
  plot.corner = precision_name;
  plot.time_axis = "ns per evaluation", plot.error_axis = "relative RMS error, down is better";
  plot.noise = result.noise, plot.time_text = time_text;
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    const Cell &cell = result.cells[i][p], &timed = cell.one_by_one ? result.cells[i][1] : cell;
    const Rung& rung = result.family.rungs[i];
    const std::string name = rung.label + (rung.is_reference ? ", the reference" : "");
    plot.points.push_back({name,
                           timed.timing.ns,
                           cell.accuracy.rms,
                           cell.one_by_one ? page::ParetoMark::kSquare : page::ParetoMark::kDisc,
                           !cell.dominated_by.empty(),
                           {name},
                           cell.one_by_one ? ", one by one: the time is that of float" : ""});
    // The plots of a family share their errors' axis.
    for (const Cell& other : result.cells[i]) plot.other_errors.push_back(other.accuracy.rms);
  }
  return drawing_of(plot);
}

}  // namespace likeness::cost
