#pragma once

#include <string_view>

namespace likeness::measured::test {

// Reads bytes as a list of bracketed frames ("brackets"), as a response ("response") or as the facts of a DNG ("dng"). True
// if they were accepted; throws std::logic_error if a promise of render/photograph does not hold.
bool feed_photograph(std::string_view format, std::string_view bytes);

}  // namespace likeness::measured::test
