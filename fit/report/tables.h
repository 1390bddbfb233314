#pragma once

#include <string>
#include <vector>

#include "fit/result/result.h"

// The tables of the report, as HTML. All strings of the result are escaped here.
namespace likeness::fit {

// All candidates of a result in the order of the page: the fit, the baselines, the talk's hand sets.
std::vector<const Candidate*> candidates_of(const Result& result);

// Every metric of every candidate: a row a metric with its definition, cut, grid and share of samples; a column a
// candidate; the best of a row marked by a word and a tint.
std::string metrics_table(const Result& result);

// Every parameter of a candidate's model: value, standard deviation, range, unit, tier, and what a reader must know
// of it; colours with a swatch.
std::string parameters_table(const Candidate& candidate, const std::string& caption);

}  // namespace likeness::fit
