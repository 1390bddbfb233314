#pragma once

#include <string_view>

namespace likeness::capture::test {

// Texts of one input are parted by this line: the four files of a capture, cameras and pictures of COLMAP.
inline constexpr std::string_view kPart = "\n====\n";

// Reads bytes as the four files of a capture ("capture"), as a list of lights ("lights_csv", "lp", "dome") or as a
// reconstruction ("colmap", "colmap_bin"). True if it was accepted; throws std::logic_error if a promise of the readers
// does not hold: what is accepted is written and read again as the same.
bool feed_capture(std::string_view format, std::string_view bytes);

}  // namespace likeness::capture::test
