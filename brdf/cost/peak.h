#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

// The most that an instruction set does on this machine: what a loop's time is held against.
namespace likeness::cost {

struct Peak {
  std::function<void()> multiply_adds;  // independent chains of a b + c, so many that the latency is hidden
  std::size_t multiply_adds_a_call;     // counted by lane
  // Over arrays in the L1 cache: xsimd's exp and log, and the processor's division and square root.
  std::function<void()> exponentials, logarithms, divisions, roots;
  std::size_t values_a_call;
};

// `set` is one of catalog::instruction_sets().
Peak peak_of(std::string_view set);

}  // namespace likeness::cost
