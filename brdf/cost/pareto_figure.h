#pragma once

#include <string>

#include "brdf/cost/study.h"

namespace likeness::cost {

// Error against time of one family in one precision, both logarithmic, as inline SVG: a named disc for each form, filled
// where no other form is at once faster and no less exact, hollow and grey where one is, and the front as a line. Forms
// far from the others stand behind a break of the axis with their numbers written out. A form that has no batches is a
// square at its time in float.
std::string pareto_figure(const FamilyResult& result, Precision precision);

}  // namespace likeness::cost
