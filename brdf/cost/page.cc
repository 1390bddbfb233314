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
  if (std::isnan(per_cycle)) return "";
  return number(per_cycle, 2) + " a cycle:\n" +
         (per_cycle >= 2.5   ? "issue"
          : per_cycle >= 1.5 ? "issue, waits"
                             : "waits");
}

std::string with_small(const std::string& text, const std::string& small) {
  return text + (small.empty() ? "" : "\n<small>" + small + "</small>") + "</td>";
}

std::string time_cell(const Cell& cell) {
  if (cell.one_by_one) return "<td class=\"n\"><small>one by one,\nas in float</small></td>";
  const std::string kind = cell.dominated_by.empty() ? "n best" : "n out";
  return "<td class=\"" + kind + "\">" +
         with_small(number(cell.timing.ns), number(cell.timing.ns_low) + " to " + number(cell.timing.ns_high));
}

// A form in words: its evaluator, its note, and whether it is worth its time.
std::string name_cell(const Rung& rung, const std::array<Cell, 3>& cells) {
  std::vector<std::pair<std::string, std::string>> by;  // a dominating form, and in what precisions it does
  for (const Precision p : {Precision::kBatch, Precision::kFloat, Precision::kDouble}) {
    const std::string& form = cells[std::size_t(p)].dominated_by;
    if (form.empty()) continue;
    const std::string name(kPrecisionNames[std::size_t(p)]);
    if (!by.empty() && by.back().first == form) by.back().second += ", " + name;
    else by.emplace_back(form, name);
  }
  std::string beaten;
  for (const auto& [form, precisions] : by)
    beaten += (beaten.empty() ? "○ dominated by " : "; ") + form + " (" + precisions + ")";
  return "<th scope=\"row\">" + escape(rung.label) +
         (rung.is_reference ? " <span class=\"badge\">reference</span>" : "") + "<small><code>" +
         escape(rung.evaluator) + "</code>" + (rung.note.empty() ? "" : ": " + escape(rung.note)) + "</small>" +
         (beaten.empty() ? "" : "<small class=\"warn\">" + escape(beaten) + "</small>") + "</th>";
}

std::string rows_of(const FamilyResult& result) {
  std::string out;
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    const auto& cells = result.cells[i];
    const Cell& batch = cells[2];
    out += "<tr>" + name_cell(result.family.rungs[i], cells);
    for (const Cell& cell : cells) out += time_cell(cell);
    out += "<td class=\"n\">" + with_small(number(cells[0].accuracy.rms), "float " + number(batch.accuracy.rms));
    out += "<td class=\"n\">" + with_small(number(cells[0].accuracy.worst), "float " + number(batch.accuracy.worst));
    if (result.family.energy_weight) out += "<td class=\"n\">" + percent(cells[0].accuracy.energy) + "</td>";
    const Cell& counted = batch.one_by_one ? cells[1] : batch;
    out += "<td class=\"n\">" + with_small(number(counted.timing.instructions), limit_of(counted));
    out += "</tr>\n";
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
  std::string out = "<h2 id=\"" + escape(family.name) + "\">" + escape(family.title) + "</h2>\n" +
                    element("p", family.text) + "\n" +
                    element("p", "Errors are of " + family.compared + ". Inputs: " + family.distribution + "; " +
                                     std::to_string(result.draws) + " draws. In worst errors, values below " +
                                     page::plain(family.negligible) + " of the RMS count as it.") +
                    "\n";
  if (result.noise > 0)
    out += element("p", "The reference is random. Its own relative RMS error, from two halves of its paths, is " +
                            number(result.noise, 2) + ": of smaller errors nothing can be said.");
  out += "<div class=\"plots\"><figure>" + pareto_figure(result, Precision::kBatch) + "</figure><figure>" +
         pareto_figure(result, Precision::kDouble) +
         "</figure></div>\n<div class=\"scroll\"><table class=\"metrics\">"
         "<thead><tr><th>form</th><th>double, ns</th><th>float, ns</th><th>batch, ns</th>"
         "<th>RMS error</th><th>worst error</th>" +
         (family.energy_weight ? "<th>" + escape(family.energy_name) + ", worst bin</th>" : "") +
         "<th>instructions, batch</th>"
         "</tr></thead><tbody>\n" +
         rows_of(result) + "</tbody></table></div>\n";
  return out + worst_places(result) +
         "<details><summary>The plot in float, one value at a time</summary><div class=\"plots\"><figure>" +
         pareto_figure(result, Precision::kFloat) + "</figure></div></details>\n";
}

// What this page adds to the style of all pages: two plots side by side, and a table that fits beside them.
constexpr std::string_view kStyle =
    ".plots{grid-template-columns:repeat(auto-fit,minmax(min(100%,520px),1fr))}"
    ".plots figure{max-width:760px}"
    ".scroll{margin-top:12px}td.best small{font-weight:400}.metrics thead th{min-width:5.4rem}.metrics thead "
    "th:first-child{min-width:13rem}"
    ".metrics td,.metrics th{padding:5px 8px}"
    "tbody th small.warn{color:#8a3b00}td.out{color:var(--quiet)}\n";

}  // namespace

std::string page_of(const Study& study) {
  std::string out = page::page_head("What accuracy costs in time: the evaluators");
  out.insert(out.find("</style>"), kStyle);
  out += "<h1>What accuracy costs in time</h1>\n";
  out +=
      "<p class=\"verdict\">Each family of evaluators from its cheapest form to its reference: nanoseconds for one "
      "evaluation on one core, against the error of its values. A filled disc, or a green time, is worth it; a hollow "
      "disc is not: another form of the family is faster and no less exact.</p>\n<nav>";
  for (const FamilyResult& result : study.families)
    out += "<a href=\"#" + escape(result.family.name) + "\">" + escape(result.family.title) + "</a>";
  const Machine& m = study.machine;
  out +=
      "</nav>\n<dl><dt>Machine</dt><dd>" + escape(m.processor) + ", one core; batches: " + escape(m.instruction_set) +
      "</dd><dt>Its most in this run</dt><dd>" + number(m.gflops) + " GFLOP/s of multiply-adds of floats in batches, " +
      number(m.exps) + " exp a nanosecond</dd><dt>Times</dt><dd>median of " + std::to_string(study.options.repeats) +
      " readings of " + number(1000 * study.options.seconds) +
      " ms of CPU time, all forms of all families in one process and in an order drawn anew for each reading; the "
      "small numbers are quartiles. Inputs and results are columns in the cache; the cost of preparing the inputs "
      "(angles, half vectors) is included: one value at a time, forms that take light and view spend some 20 ns in "
      "computing every angle of the pair, which each of them has done whole even where it reads little of it. 'One by "
      "one': the evaluator has branches and no form for batches; plots "
      "show it as a square at its time in float, and it is compared with no other.</dd><dt>Errors</dt><dd>RMS: of the "
      "difference over the draws, divided by the RMS of the "
      "reference. Worst: largest relative difference, where values below a stated small share of that RMS count as it. "
      "The large numbers are in double; in float and batches (small) rounding comes on top, of inputs "
      "too.</dd><dt>Instructions</dt><dd>" +
      std::string(m.has_counters
                      ? "counted by the processor in user space; how many it completes in a cycle tells what "
                        "limits a loop. 'issue', at 2.5 and more: their number. 'waits', below 1.5: results of "
                        "earlier ones, divisions, roots or tables. Between: some of each."
                      : "this machine offers no counters to read.") +
      "</dd></dl>\n";
  for (const FamilyResult& result : study.families) out += section_of(result);
  return out + page::page_foot();
}

}  // namespace likeness::cost
