#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "render/image/layers.h"
#include "render/image/picture.h"

// Texts in the header of an EXR beside its picture: what the picture is of.
namespace likeness::image {

using Attributes = std::map<std::string, std::string>;  // name to text; names by habit are prefix:name

// Linear RGB with these string attributes. The file is whole or absent. Throws std::runtime_error.
void write_exr(const std::filesystem::path& file, const Picture& picture, const Attributes& attributes,
               Storage storage = Storage::kFloat);

// The string attributes of the first part, without a look at its pixels. Nothing if there is no such file, if it is no
// EXR, or if lines of it are missing.
std::optional<Attributes> attributes_of_whole_exr(const std::filesystem::path& file);

}  // namespace likeness::image
