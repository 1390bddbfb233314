#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace likeness::measured {

static_assert(std::endian::native == std::endian::little, "the binary formats are read as they lie in memory");

// The number at byte `at`; the caller has checked that at + sizeof(T) <= bytes.size().
template <class T>
T number_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace likeness::measured
