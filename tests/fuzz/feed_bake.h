#pragma once

#include <string>
#include <string_view>

namespace likeness::baked::test {

// Reads bytes as bake.json, surface.json and the surface's material, parted by a line "====", over pictures of 7 x 5 texels
// that are there under any name; then as a scene would. True if it was accepted; throws std::logic_error if a promise of
// render/baked does not hold.
bool feed_bake(std::string_view bytes);

// A bake of 7 x 5 texels, as such bytes.
std::string small_bake(std::size_t lobes, std::size_t kept, std::string_view channels, std::string_view storage);

}  // namespace likeness::baked::test
