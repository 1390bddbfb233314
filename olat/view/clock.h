#pragma once

#include <chrono>

namespace likeness::olat_view {

// Since some moment in the past; never goes back.
inline long milliseconds_now() {
  using std::chrono::steady_clock;
  return static_cast<long>(
      std::chrono::duration_cast<std::chrono::milliseconds>(steady_clock::now().time_since_epoch()).count());
}

}  // namespace likeness::olat_view
