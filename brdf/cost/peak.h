#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

// The most that an instruction set does on this machine: what a loop's time is held against.
namespace likeness::cost {

struct Peak {
  std::function<void()> multiply_adds;  // independent chains of a b + c, one for each register that hides the latency
  std::size_t multiply_adds_a_call;     // counted by lane
  std::function<void()> exponentials;   // xsimd's exp over an array in the L1 cache
  std::size_t exponentials_a_call;
};

// `set` is one of catalog::instruction_sets().
Peak peak_of(std::string_view set);

}  // namespace likeness::cost
