#pragma once

#include <vector>

#include "fit/objective.h"

namespace likeness::fit {

// Every channel of every parameter of a fitted model: value, standard deviation, bounds reached, and whether the data
// depend on it at all.
//
// sigma       from the covariance H^-1 M H^-1 of the variables that are not at a bound, H = J^T J and M the sum over
//             samples of (r dr)(r dr)^T, carried over to intensity and tint where a product was fitted: White 1980,
//             eq. 7, in place of s^2 H^-1, because the residuals of a measured material are not of one size (noise that
//             grows with the value made sigma of a roughness four times too small). It takes residuals as
//             independent; model error is not, so it is a lower bound.
// matters     false where moving the parameter alone anywhere in its range raises the loss by less than 1 %.
std::vector<Estimate> estimates_of(const SampleSet& samples, const Coordinates& coordinates,
                                   const std::vector<double>& folded_channels);

}  // namespace likeness::fit
