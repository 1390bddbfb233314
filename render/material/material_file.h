#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "brdf/any_brdf.h"

namespace likeness::material {

inline constexpr std::string_view kExtension = ".material.json";
inline constexpr std::size_t kLargestFile = 1 << 20;  // bytes; a full Callisto material takes about one thousand

// What a material file holds. The format is described in docs/material_file.md.
struct Material {
  std::string name;  // for people; any UTF-8 text, may be empty
  brdf::AnyBrdf brdf;
};

// The text of a material file: every parameter of the model in table order, each number as the shortest decimal
// that reads back as the same double. Precondition: every parameter is within its range; otherwise throws
// std::invalid_argument that names the parameter, so that no file is written that cannot be read.
std::string text_of(const Material& material);

// The inverse. Parameters that the text does not name take their defaults. Throws files::InputError: one line
// that begins with `source` and the line number.
Material material_of(std::string_view text, const std::string& source);

// The same, from and to a file. Writing leaves the old file or the new one, never a part.
Material read_material(const std::filesystem::path& file);
void write_material(const std::filesystem::path& file, const Material& material);

}  // namespace likeness::material
