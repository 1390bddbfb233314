#include <cstddef>
#include <cstdint>

#include "tests/fuzz/feed_bake.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  likeness::baked::test::feed_bake({reinterpret_cast<const char*>(data), size});
  return 0;
}
