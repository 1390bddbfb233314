#pragma once

#include <string>

#include "brdf/cost/study.h"

namespace likeness::cost {

// Error against time of one family in one precision, both logarithmic: a numbered disc for each form, filled where no
// other form is at once faster and no less exact, hollow where one is, and the front as a line. Inline SVG.
std::string pareto_figure(const FamilyResult& result, Precision precision);

}  // namespace likeness::cost
