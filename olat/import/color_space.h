#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "render/capture/capture.h"

// What the numbers of photographs mean: said by the user, by their format's definition, or by the file that lists them.
namespace likeness::olat_import {

struct ColorSpace {
  std::string_view name;
  capture::Transfer transfer;
  capture::Primaries primaries;
  std::string_view text;
};

// The words of --color-space.
inline constexpr std::array kColorSpaces{
    ColorSpace{"linear", capture::Transfer::kLinear, capture::Primaries::kRec709, "in proportion to light, Rec. 709"},
    ColorSpace{"srgb", capture::Transfer::kSrgb, capture::Primaries::kRec709, "sRGB curve: usual JPEG, PNG, TGA"},
    ColorSpace{"rec709", capture::Transfer::kRec709, capture::Primaries::kRec709, "video: the curve of ITU-R BT.709"},
    ColorSpace{"gamma22", capture::Transfer::kGamma22, capture::Primaries::kRec709, "a power of 2.2"},
    ColorSpace{"acescg", capture::Transfer::kLinear, capture::Primaries::kAcesCg, "linear, primaries of ACEScg"},
    ColorSpace{"camera", capture::Transfer::kLinear, capture::Primaries::kCamera,
               "linear, the camera's own primaries (cameras.json has a matrix)"},
};

// Throws files::UsageError with the nearest word.
const ColorSpace& color_space_named(const std::string& name);

struct Known {
  const ColorSpace* space = nullptr;
  std::string reason;  // how that is known
};
// By the definition of the format, as the file's ending says it: EXR, PFM and HDR hold light, and DNG is linear when it is
// read. Nothing for the others.
std::optional<Known> known_by_format(const std::filesystem::path& file);

// By a remark of a list of lights: the word "linear" by itself. Nothing if it is not there.
std::optional<Known> known_by_remark(std::string_view remarks, const std::string& name);

// Endings of files of photographs, in small letters.
bool is_photograph(const std::filesystem::path& file);

std::string lower(std::string text);

}  // namespace likeness::olat_import
