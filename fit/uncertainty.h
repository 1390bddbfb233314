#pragma once

#include <vector>

#include "fit/objective.h"

namespace likeness::fit {

// Every channel of every parameter of a fitted model: value, standard deviation, bounds reached, and whether the data
// depend on it at all.
//
// sigma       from the covariance s^2 (J^T J)^-1 of the variables that are not at a bound, s^2 = |r|^2 / (samples -
//             variables), carried over to intensity and tint where a product was fitted. It is the spread that the
//             residuals would give if they were independent; model error is not, so it is a lower bound.
// matters     false where moving the parameter alone anywhere in its range raises the loss by less than 1 %.
std::vector<Estimate> estimates_of(const SampleSet& samples, const Coordinates& coordinates,
                                   const std::vector<double>& folded_channels);

}  // namespace likeness::fit
