#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "brdf/any_brdf.h"
#include "datasets_synthetic/faults.h"
#include "datasets_synthetic/table.h"

// Measured-material files whose truth is known: made from an evaluator instead of an instrument.
namespace likeness::datasets_synthetic {

// One file to be made.
struct Material {
  brdf::AnyBrdf brdf;
  Grid grid;
  Faults faults;
  std::uint64_t seed = 0;  // of the faults
};

// The file, and what was done to it. A function of the Material alone: the same bytes on any number of threads.
struct Made {
  std::string bytes;
  Counts counts;
};
Made make(const Material& material);

// The model with every parameter drawn evenly from its usual range (Parameter::typical).
brdf::AnyBrdf drawn(const brdf::AnyBrdf& model, std::uint64_t seed);

// What there is to know about a made file, as JSON text (docs/make_material.md). `file` is its name without folder.
std::string manifest_of(const Material& material, const Made& made, const std::string& file);

// Makes `file`, and beside it NAME.truth.json (the manifest, which is returned) and NAME.material.json (the truth
// as a material file). Each is whole or absent, and where `file` is, the others are. Throws files::UsageError if
// `file` exists but the manifest beside it is not its own (it was not made here, or the manifest is another
// format's of the same name), or if truncation leaves nothing.
std::string write(const Material& material, const std::filesystem::path& file);

// ".binary", ".mbsdf" or ".csv".
std::string_view extension_of(measured::Format format);

}  // namespace likeness::datasets_synthetic
