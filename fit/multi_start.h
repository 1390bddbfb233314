#pragma once

#include <functional>
#include <vector>

#include "fit/interrupted.h"
#include "fit/objective.h"

namespace likeness::fit {

// One fit of one model or tier: many starts on coarse samples, the best few finished exactly.
struct MultiStart {
  int starts = 40;                        // drawn starts; the same ones for every material and thread count
  int finished = 3;                       // how many of them are finished on all samples
  std::vector<std::vector<double>> warm;  // folded channels of known optima (the poorer tier's); always finished
  std::function<bool()> stop;             // true: give up (throws Interrupted)
};

struct Optimum {
  std::vector<double> channels;      // folded
  double loss = 0;                   // at kExact, of those channels
  std::vector<Step> steps;           // of the winner, over all samples
  std::vector<double> start_losses;  // of the drawn starts, on the coarse samples
  int best_start = -1;               // -1: the warm start won
  int evaluations = 0;
  double cpu_seconds = 0;  // over all threads
};

Optimum minimise(const SampleSet& samples, const Coordinates& coordinates, const MultiStart& how);

}  // namespace likeness::fit
