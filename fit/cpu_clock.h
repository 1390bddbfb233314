#pragma once

#include <ctime>

namespace likeness::fit {

// CPU seconds of the calling thread since it began; differences tell what a piece of work cost.
inline double thread_cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace likeness::fit
