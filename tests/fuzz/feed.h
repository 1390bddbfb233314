#pragma once

#include <string>
#include <string_view>

namespace likeness::measured::test {

// Parses bytes as one format ("merl", "mbsdf", "rgl", "csv") and uses whatever comes out of it. True if it was
// accepted; throws std::logic_error if a promise of measured.h does not hold. MERL has the small size of the corpus.
bool feed(std::string_view format, std::string_view bytes);

}  // namespace likeness::measured::test
