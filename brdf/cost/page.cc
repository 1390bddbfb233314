#include <cmath>

#include "brdf/cost/pareto_figure.h"
#include "brdf/cost/study.h"
#include "render/page/html.h"

namespace likeness::cost {
namespace {

using page::element;
using page::escape;
using page::number;

std::string percent(double share) {
  if (std::isnan(share)) return "-";
  return std::abs(share) < 5e-7 ? "0 %" : number(100 * share, 2) + " %";
}

// What keeps a loop from running faster, as far as its counters tell.
std::string limit_of(const Cell& cell) {
  const double per_cycle = cell.timing.instructions / cell.timing.cycles;
  if (std::isnan(per_cycle)) return "-";
  const std::string ipc = number(per_cycle, 2) + " a cycle";
  return ipc + (per_cycle >= 2.5   ? ": issue"
                : per_cycle >= 1.5 ? ": issue and latency"
                                   : ": latency, divisions, tables");
}

std::string rows_of(const FamilyResult& result) {
  std::string out;
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    const Rung& rung = result.family.rungs[i];
    const auto& cells = result.cells[i];
    out += "<tr><td class=\"n\">" + std::to_string(i + 1) + "</td><th scope=\"row\">" + escape(rung.label) +
           (rung.is_reference ? " <span class=\"badge\">reference</span>" : "") + "<small><code>" +
           escape(rung.evaluator) + "</code>" + (rung.note.empty() ? "" : ": " + escape(rung.note)) + "</small></th>";
    for (const Cell& cell : cells) {
      out += "<td class=\"n" + std::string(cell.dominated_by.empty() ? " best" : "") + "\">" + number(cell.timing.ns) +
             "\n<small>" + number(cell.timing.ns_low) + " to " + number(cell.timing.ns_high) + "</small></td>";
    }
    const Cell& batch = cells[2];
    out += "<td class=\"n\">" + number(batch.timing.instructions) + "\n<small>" + escape(limit_of(batch)) +
           "</small></td>";
    out += "<td class=\"n\">" + number(cells[0].accuracy.rms) + "\n<small>batch " + number(batch.accuracy.rms) +
           "</small></td>";
    out += "<td class=\"n\">" + number(cells[0].accuracy.worst) + "\n<small>batch " + number(batch.accuracy.worst) +
           "</small></td>";
    if (result.family.energy_weight) out += "<td class=\"n\">" + percent(cells[0].accuracy.energy) + "</td>";
    out += "<td>" + escape(batch.dominated_by.empty() ? "-" : batch.dominated_by) + "</td></tr>\n";
  }
  return out;
}

std::string worst_places(const FamilyResult& result) {
  std::string out = "<details><summary>Where each form is farthest off (in double)</summary><dl>";
  for (std::size_t i = 0; i < result.cells.size(); ++i)
    out += "<dt>" + escape(result.family.rungs[i].label) + "</dt><dd>" + number(result.cells[i][0].accuracy.worst) +
           " at " + escape(result.cells[i][0].accuracy.where) + "</dd>";
  return out + "</dl></details>\n";
}

std::string section_of(const FamilyResult& result) {
  const Family& family = result.family;
  std::string out =
      "<h2 id=\"" + escape(family.name) + "\">" + escape(family.title) + "</h2>\n" + element("p", family.text) + "\n" +
      element("p", "Inputs: " + family.distribution + "; " + std::to_string(result.draws) + " draws.") + "\n";
  out += "<div class=\"plots\">";
  for (const Precision p : {Precision::kBatch, Precision::kFloat, Precision::kDouble})
    out += "<figure>" + pareto_figure(result, p) + "</figure>";
  out +=
      "</div>\n<div class=\"scroll\"><table class=\"metrics\"><thead><tr><th style=\"min-width:0\"></th><th "
      "style=\"min-width:12rem\">form</th><th>double, ns</th>"
      "<th>float, ns</th><th>batch, ns</th><th>instructions, batch</th><th>RMS error</th><th>worst error</th>" +
      std::string(family.energy_weight ? "<th>" + escape(family.energy_name) + ", worst bin</th>" : "") +
      "<th>dominated in batches by</th></tr></thead><tbody>\n" + rows_of(result) + "</tbody></table></div>\n";
  return out + worst_places(result);
}

}  // namespace

std::string page_of(const Study& study) {
  std::string out = page::page_head("What accuracy costs in time: the evaluators");
  out += "<h1>What accuracy costs in time</h1>\n";
  out +=
      "<p class=\"verdict\">Each family of evaluators from its cheapest form to its reference: nanoseconds for one "
      "evaluation on one core, against the error of its values. A filled disc is worth its time; a hollow one is not: "
      "another form of the family is faster and no less exact.</p>\n<nav>";
  for (const FamilyResult& result : study.families)
    out += "<a href=\"#" + escape(result.family.name) + "\">" + escape(result.family.title) + "</a>";
  const Machine& m = study.machine;
  out +=
      "</nav>\n<dl><dt>Machine</dt><dd>" + escape(m.processor) + ", one core; batches: " + escape(m.instruction_set) +
      "</dd><dt>Its most in this run</dt><dd>" + number(m.gflops) + " GFLOP/s of multiply-adds of floats in batches, " +
      number(m.exps) + " exp a nanosecond</dd><dt>Times</dt><dd>median of " + std::to_string(study.options.repeats) +
      " readings of " + number(1000 * study.options.seconds) +
      " ms of CPU time, all forms of all families in one process and in an order drawn anew for each reading; the "
      "small "
      "numbers are quartiles. Inputs and results are columns in the cache; the cost of preparing the inputs (angles, "
      "half "
      "vectors) is included.</dd><dt>Errors</dt><dd>RMS: of the difference over the draws, divided by the RMS of the "
      "reference. Worst: largest relative difference, where values below a stated small share of that RMS count as it. "
      "double and batch differ by the rounding of floats, of inputs too.</dd><dt>Instructions</dt><dd>" +
      std::string(m.has_counters
                      ? "counted by the processor in user space; how many it completes in a cycle tells what "
                        "limits a loop: 'issue', at 2.5 and more, their number; 'waits', below 1.5, results of "
                        "earlier ones, divisions, roots or tables."
                      : "this machine offers no counters to read.") +
      "</dd></dl>\n";
  for (const FamilyResult& result : study.families) out += section_of(result);
  return out + page::page_foot();
}

}  // namespace likeness::cost
