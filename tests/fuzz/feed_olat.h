#pragma once

#include <string_view>

namespace likeness::olat_pair::test {

// Reads bytes as packets of tev, one after the other ("tev"), or as the text of a state of the viewer ("state"). True if
// all of it was accepted; throws std::logic_error if a promise of olat/tev or olat/pair/state.h does not hold.
bool feed_olat(std::string_view format, std::string_view bytes);

}  // namespace likeness::olat_pair::test
