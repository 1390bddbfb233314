#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

// Time of short pieces of work, measured side by side.
namespace likeness::cost {

// A piece of work that evaluates `evaluations` at every call of run().
struct Task {
  std::function<void()> run;
  std::size_t evaluations = 1;
};

// Per evaluation. Counters are NaN where the machine has none to read.
struct Timing {
  double ns = 0, ns_low = 0, ns_high = 0;  // median and quartiles over the repeats, CPU time of the thread
  double instructions = 0, cycles = 0;     // in user space, median
};

// Runs every task `repeats` times, each time for about `seconds` of CPU, in an order that is drawn anew for each
// repeat: what disturbs the machine disturbs all of them alike. `progress` is told the share that is done.
std::vector<Timing> time_interleaved(const std::vector<Task>& tasks, int repeats, double seconds,
                                     const std::function<void(double)>& progress);

// What the machine is, and what it reaches in this very minute on one core.
struct Machine {
  std::string processor;        // as it calls itself
  std::string instruction_set;  // of the batches
  double gflops = 0;            // multiply-adds of floats in the widest batches, two operations each [1e9/s]
  double exps = 0;              // xsimd's exp of floats [1e9/s]
  bool has_counters = false;
};
Machine machine();

}  // namespace likeness::cost
