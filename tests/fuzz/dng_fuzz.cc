#include <cstddef>
#include <cstdint>

#include "tests/fuzz/feed.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  likeness::measured::test::feed("dng", {reinterpret_cast<const char*>(data), size});
  return 0;
}
