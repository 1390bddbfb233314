#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "render/json/section.h"

// Names, keys and limits of a bake's files, for its reader and its writer.
namespace likeness::baked {

inline constexpr std::size_t kMostBakeBytes = std::size_t{1} << 26;  // of bake.json
inline constexpr int kBakeVersion = 1;
inline constexpr std::array<std::string_view, 2> kChannels{"luminance", "rgb"};
inline constexpr std::array<std::string_view, 4> kStorages{"8 bit", "float", "4 bit", "8 bit squared"};
inline constexpr std::array<std::string_view, 2> kSpaces{"image", "texture"};
inline constexpr const char *kBakeFile = "bake.json", *kFloats = "coefficients.exr", *kBakeType = "realis bake",
                            *kSurfaceFile = "surface.json", *kNormals = "normal.png", *kColors = "base_color.png",
                            *kMaterial = "surface.material.json";

// The picture of three planes from 3 * index on: "lobes_000.png", "coefficients_000.png".
std::string numbered(const char* name, std::size_t index);

extern const json::Section kBakeSection;

}  // namespace likeness::baked
