#pragma once

#include "fit/coordinates.h"
#include "fit/levenberg_marquardt.h"
#include "fit/samples.h"

namespace likeness::fit {

// Which of a SampleSet's arrays to sum over.
enum class Fineness { kCoarse, kSingle, kExact };

// The fitted loss, the weighted mean of the squared residuals, in a fit's variables: the function that the
// minimiser sees. kExact sums in double over the whole slice, or over every sample of the table in fixed chunks,
// in parallel, added in order: the same bits for any number of threads.
// `scatter`: the hessian gathers (r dr)(r dr)^T in place of dr dr^T.
Quadratic objective(const SampleSet& samples, const Coordinates& coordinates, const Eigen::VectorXd& x,
                    Fineness fineness, bool scatter = false);

// The loss alone at some channels, at kExact.
double exact_loss(const SampleSet& samples, std::size_t model, const std::vector<double>& folded_channels);

// What the exact loss's sums are multiplied by: 1 / (3 sum of weights).
double residual_scale(const SampleSet& samples);

// How many numbers the exact loss sums: samples times color channels.
std::size_t residual_count(const SampleSet& samples);

}  // namespace likeness::fit
