#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace likeness::measured::test {

inline void hold(bool promise, const char* text) {
  if (!promise) throw std::logic_error(text);
}

// Parses bytes as one format ("merl", "mbsdf", "rgl", "csv") and uses whatever comes out of it. True if it was
// accepted; throws std::logic_error if a promise of measured.h does not hold. MERL has the small size of the corpus.
// The format "table" goes to feed_table, "exr" to feed_exr, "bake" to feed_bake, and those of scenes to feed_scene.
bool feed(std::string_view format, std::string_view bytes);

// Evaluates bytes as a table of inputs (brdf/eval/rows.h) of an evaluator with two forms, colors and directions. True if
// every row was accepted; throws std::logic_error if a promise of rows.h does not hold.
bool feed_table(std::string_view bytes);

// Reads bytes as a scene ("scene": scene.json, whose files are those of tests/render/scene/small_files.h), as a mesh file
// ("glb", "ply", "obj") or as a light's profile ("ies"). True if it was accepted; throws std::logic_error if a promise of
// render/scene/read_scene.h does not hold.
bool feed_scene(std::string_view format, std::string_view bytes);

}  // namespace likeness::measured::test
