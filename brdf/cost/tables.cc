#include <algorithm>
#include <cmath>
#include <cstdio>

#include "brdf/cost/study.h"

namespace likeness::cost {
namespace {

std::string digits(double value, int significant = 3) {
  if (std::isnan(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", significant, value);
  return text;
}

// A cell of CSV, in quotes where it has to be.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string signed_percent(double share) {
  if (std::isnan(share)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%+.2g %%", 100 * share);
  return text;
}

// The order of docs/cost.md: what a renderer pays first; errors are those in double.
std::string markdown_of(const FamilyResult& result) {
  const bool has_energy = bool(result.family.energy_weight);
  std::string out =
      "<!-- table: " + result.family.name + " -->\n| form | batch, ns | float, ns | double, ns | RMS error | worst |";
  out += (has_energy ? " " + result.family.energy_name + " |" : "") +
         std::string("\n| --- | --- | --- | --- | --- | --- |");
  out += std::string(has_energy ? " --- |" : "") + "\n";
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    const auto& c = result.cells[i];
    out += "| " + result.family.rungs[i].label;
    for (const std::size_t p : {std::size_t(2), std::size_t(1), std::size_t(0)})
      out +=
          " | " + (c[p].one_by_one ? "one by one" : digits(c[p].timing.ns) + (c[p].dominated_by.empty() ? "" : "\\*"));
    out += " | " + digits(c[0].accuracy.rms) + " | " + digits(c[0].accuracy.worst);
    if (has_energy) out += " | " + signed_percent(c[0].accuracy.energy);
    out += " |\n";
  }
  return out + "<!-- end -->\n";
}

// Code points, not bytes, are what a terminal shows.
std::size_t shown_width(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string space(width - std::min(width, shown_width(text)), ' ');
  return right ? space + text : text + space;
}

// Columns as wide as what is in them, two spaces apart; the first to the left.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const auto& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], shown_width(row[k]));
  std::string out;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) line += "  " + padded(row[k], widths[k], k > 0);
    out += line + "\n";
  }
  return out;
}

std::string table_of(const FamilyResult& result) {
  const bool has_energy = bool(result.family.energy_weight);
  std::vector<std::vector<std::string>> rows{{"", "double ns", "float ns", "batch ns", "spread", "rms error", "worst"}};
  if (has_energy) rows[0].push_back(result.family.energy_name);
  for (std::size_t i = 0; i < result.cells.size(); ++i) {
    const auto& c = result.cells[i];
    const Rung& rung = result.family.rungs[i];
    std::vector<std::string> row{rung.label + (rung.is_reference ? " (reference)" : "")};
    for (const Cell& x : c)
      row.push_back(x.one_by_one ? "one by one " : digits(x.timing.ns) + (x.dominated_by.empty() ? " " : "*"));
    const Timing& spread = c[2].one_by_one ? c[1].timing : c[2].timing;
    row.push_back(digits(100 * (spread.ns_high - spread.ns_low) / spread.ns, 2) + "%");
    row.push_back(digits(c[2].accuracy.rms));
    row.push_back(digits(c[2].accuracy.worst));
    if (has_energy) row.push_back(digits(c[2].accuracy.energy));
    rows.push_back(std::move(row));
  }
  std::string out = "\n" + result.family.title + " (" + result.family.name + "), errors of " + result.family.compared +
                    "\n" + aligned(rows);
  if (result.noise > 0) out += "  The reference is random: its own rms error is " + digits(result.noise, 2) + ".\n";
  return out;
}

}  // namespace

std::string csv_of(const Study& study) {
  std::string out =
      "family,form,evaluator,precision,loop,ns,ns_quartile_1,ns_quartile_3,instructions,cycles,rms_error,worst_error,"
      "energy_error,noise,worst_at,dominated_by,machine,instruction_set\n";
  for (const FamilyResult& result : study.families)
    for (std::size_t i = 0; i < result.cells.size(); ++i)
      for (std::size_t p = 0; p < 3; ++p) {
        const Rung& rung = result.family.rungs[i];
        const Cell& c = result.cells[i][p];
        out += result.family.name + "," + cell(rung.label) + "," + rung.evaluator + "," +
               std::string(kPrecisionNames[p]) + "," +
               (c.one_by_one ? "one by one"
                : p == 2     ? "batches"
                             : "scalar") +
               "," + digits(c.timing.ns, 5) + "," + digits(c.timing.ns_low, 5) + "," + digits(c.timing.ns_high, 5) +
               "," + digits(c.timing.instructions, 5) + "," + digits(c.timing.cycles, 5) + "," +
               digits(c.accuracy.rms, 5) + "," + digits(c.accuracy.worst, 5) + "," + digits(c.accuracy.energy, 5) +
               "," + digits(result.noise, 3) + "," + cell(c.accuracy.where) + "," + cell(c.dominated_by) + "," +
               cell(study.machine.processor) + "," + study.machine.instruction_set + "\n";
      }
  return out;
}

std::string table_of(const Study& study) {
  std::string out = study.machine.processor + ", batches: " + study.machine.instruction_set + ", " +
                    digits(study.machine.gflops) + " GFLOP/s of multiply-adds, " + digits(study.machine.exps) +
                    " exp/ns, in this run on one core\n";
  for (const FamilyResult& result : study.families) out += table_of(result);
  return out +
         "\nErrors and spread are those of the batches. * another form is faster and no less exact. 'one by one': the "
         "evaluator\nhas branches and no form for batches.\n";
}

std::string markdown_of(const Study& study) {
  std::string out;
  for (const FamilyResult& result : study.families) out += (out.empty() ? "" : "\n") + markdown_of(result);
  return out;
}

}  // namespace likeness::cost
