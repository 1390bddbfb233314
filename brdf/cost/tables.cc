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

std::string padded(const std::string& text, std::size_t width, bool right) {
  // Code points, not bytes, are what a terminal shows.
  std::size_t shown = 0;
  for (const char c : text) shown += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  const std::string space(shown < width ? width - shown : 0, ' ');
  return right ? space + text : text + space;
}

}  // namespace

std::string csv_of(const Study& study) {
  std::string out =
      "family,form,evaluator,precision,ns,ns_quartile_1,ns_quartile_3,instructions,cycles,rms_error,worst_error,"
      "energy_error,worst_at,dominated_by,machine,instruction_set\n";
  for (const FamilyResult& result : study.families)
    for (std::size_t i = 0; i < result.cells.size(); ++i)
      for (std::size_t p = 0; p < 3; ++p) {
        const Rung& rung = result.family.rungs[i];
        const Cell& c = result.cells[i][p];
        out += result.family.name + "," + cell(rung.label) + "," + rung.evaluator + "," +
               std::string(kPrecisionNames[p]) + "," + digits(c.timing.ns, 5) + "," + digits(c.timing.ns_low, 5) + "," +
               digits(c.timing.ns_high, 5) + "," + digits(c.timing.instructions, 5) + "," + digits(c.timing.cycles, 5) +
               "," + digits(c.accuracy.rms, 5) + "," + digits(c.accuracy.worst, 5) + "," +
               digits(c.accuracy.energy, 5) + "," + cell(c.accuracy.where) + "," + cell(c.dominated_by) + "," +
               cell(study.machine.processor) + "," + study.machine.instruction_set + "\n";
      }
  return out;
}

std::string table_of(const Study& study) {
  std::string out = study.machine.processor + ", batches: " + study.machine.instruction_set + ", " +
                    digits(study.machine.gflops) + " GFLOP/s of multiply-adds, " + digits(study.machine.exps) +
                    " exp/ns, in this run on one core\n";
  for (const FamilyResult& result : study.families) {
    out += "\n" + result.family.title + " (" + result.family.name + ")\n" + padded("", 34, false) +
           padded("double ns", 12, true) + padded("float ns", 12, true) + padded("batch ns", 12, true) +
           padded("spread", 8, true) + padded("rms error", 11, true) + padded("worst", 10, true) +
           padded(result.family.energy_weight ? result.family.energy_name : "", 12, true) + "\n";
    for (std::size_t i = 0; i < result.cells.size(); ++i) {
      const auto& c = result.cells[i];
      out += padded("  " + result.family.rungs[i].label + (result.family.rungs[i].is_reference ? " (reference)" : ""),
                    34, false);
      for (const Cell& x : c) out += padded(digits(x.timing.ns) + (x.dominated_by.empty() ? "" : "*"), 12, true);
      out += padded(digits(100 * (c[2].timing.ns_high - c[2].timing.ns_low) / c[2].timing.ns, 2) + "%", 8, true) +
             padded(digits(c[2].accuracy.rms), 11, true) + padded(digits(c[2].accuracy.worst), 10, true) +
             padded(digits(c[2].accuracy.energy), 12, true) + "\n";
    }
  }
  return out + "\nErrors and spread are those of the batches. * another form is faster and no less exact.\n";
}

}  // namespace likeness::cost
