#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "brdf/evaluator.h"

// Every evaluator of brdf/ at run time: by name, with its tables of inputs and outputs, and with loops over columns in
// double, in float and in batches of floats for the best instruction set of the machine.
namespace likeness::catalog {

// One value for each row, or one for all of them.
template <class N>
struct Column {
  const N* data = nullptr;
  bool constant = false;  // data[0] holds for every row
};

// Evaluates `count` rows. `in` has an entry for each feature or input, `out` for each output (colors by channel); the
// columns of `out` must not overlap one another nor `in`. Neither throws nor allocates, but for the first use of tables.
template <class N>
using Loop = void (*)(const void* tables, const Column<N>* in, N* const* out, std::size_t count);

template <class N>
struct Loops {
  Loop<N> from_features = nullptr;
  Loop<N> from_inputs = nullptr;  // of the first form, everything in N
};

// A way to name the inputs of an evaluator (brdf/evaluator.h).
struct Form {
  std::span<const brdf::Parameter> inputs;
  std::size_t count;  // of inputs, colors by channel
  void (*prepare)(const double* in, double* features);
};

struct Entry {
  std::string_view name, family, text;
  std::vector<Form> forms;
  std::span<const brdf::Output> outputs;
  std::size_t features, output_count;  // colors by channel
  const void* (*tables)();             // what the loops take first; made at the first call, then kept
  Loops<double> in_double;
  Loops<float> in_float;
  Loops<float> in_batches;  // same as in_float where an evaluator has branches (one_by_one)
  bool one_by_one;
};

// All of them, family by family. The first call chooses the instruction set.
const std::vector<Entry>& entries();

// The entry of that name, nullptr if there is none.
const Entry* find(std::string_view name);

// What the batches are made of: "baseline" (SSE2), "avx2" or "avx512". LIKENESS_INSTRUCTION_SET in the environment asks
// for a lesser one than the machine has; std::invalid_argument names what is wrong with it.
std::string_view instruction_set();

// The sets that this processor has, the least first.
std::vector<std::string_view> instruction_sets();

// The loops over batches of one evaluator in a set that the processor has, to compare sets. No loops if one_by_one.
Loops<float> loops_in(std::string_view set, std::string_view name);

}  // namespace likeness::catalog
