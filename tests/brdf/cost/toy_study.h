#pragma once

#include <limits>
#include <string>

#include "brdf/cost/study.h"

// Results that nobody measured.
namespace likeness::cost::test {

inline Cell cell(double ns, double rms, double spread = 0.1) {
  Cell c;
  c.timing = {ns, ns - spread, ns + spread, 10 * ns, 4 * ns};
  c.accuracy.rms = c.accuracy.worst = rms;
  c.accuracy.energy = -rms;
  c.accuracy.where = "x = 1, y = 2";
  return c;
}

inline Cell one_by_one(double rms) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  Cell c = cell(none, rms);
  c.one_by_one = true;
  return c;
}

inline FamilyResult toy_family() {
  FamilyResult result;
  result.family.name = "toys";
  result.family.title = "Toys & <tools>";
  result.family.text = "What \"toys\" do.";
  result.family.distribution = "even";
  result.family.energy_name = "light";
  result.family.energy_weight = [](const double*) { return 1.0; };
  result.draws = 100;
  result.family.rungs = {{.label = "cheap, rough", .evaluator = "a", .inputs = {}, .note = "a <note>"},
                         {.label = "slow & rough", .evaluator = "b", .inputs = {}},
                         {.label = "a \"table\"", .evaluator = "c", .inputs = {}},
                         {.label = "walk", .evaluator = "d", .inputs = {}},
                         {.label = "exact", .evaluator = "e", .inputs = {}, .is_reference = true}};
  result.cells = {{cell(10, 0.2), cell(8, 0.2), cell(1, 0.2)},
                  {cell(20, 0.3), cell(16, 0.3), cell(3, 0.3)},
                  {cell(30, 0.01), cell(24, 0.01), cell(5, 0.01)},
                  {cell(9000, 0.02), cell(8000, 0.02), one_by_one(0.02)},
                  {cell(400, 0), cell(300, 1e-7), cell(60, 1e-7)}};
  return result;
}

inline Study toy_study() {
  Study study;
  study.machine = {"Processor, \"fast\"", "avx2", 100, 2.5, true};
  study.families = {toy_family()};
  find_dominated(study.families[0]);
  return study;
}

}  // namespace likeness::cost::test
