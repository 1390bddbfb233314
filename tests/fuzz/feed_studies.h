#pragma once

#include <string_view>

namespace likeness::measured::test {

// Reads bytes as reflectances of tears ("readings"), as colors of blood ("blood_table") or as a kernel of glare
// ("bloom_kernel"). True if they were accepted; throws std::logic_error if a promise of the readers does not hold.
bool feed_studies(std::string_view format, std::string_view bytes);

}  // namespace likeness::measured::test
