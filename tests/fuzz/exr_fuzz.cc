#include <cstddef>
#include <cstdint>

#include "tests/fuzz/feed_exr.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  likeness::image::test::feed_exr({reinterpret_cast<const char*>(data), size});
  return 0;
}
