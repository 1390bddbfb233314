#include "render/baked/format.h"

#include <cstdio>

#include "render/baked/bake.h"

namespace likeness::baked {
namespace {

using json::Form;
using json::Key;

// clang-format off
constexpr std::array kLobeKeys{
    Key{.name = "axis", .form = Form::kVector, .required = true, .text = "of the lobe, unit; in the world's axes, or in those of the object whose texture it is"},
    Key{.name = "sharpness", .form = Form::kNumber, .range = {0, 1e6}, .required = true, .text = "of its Gaussian"},
    Key{.name = "spread", .form = Form::kNumber, .range = {0, 1e12}, .required = true, .text = "standard deviation that its coefficients had before anything was seen, over that of a sample"},
    Key{.name = "multiplier", .form = Form::kNumbers, .range = {0, 1e12}, .unit = "1/sr", .required = true, .text = "coefficient that 127 stands for, of each channel"},
};
constexpr json::Section kLobeSection{"lobe", "A windowed spherical Gaussian that all texels share.", kLobeKeys};
constexpr std::array<const json::Section*, 1> kLobeOnly{&kLobeSection};
constexpr std::array kMixKeys{
    Key{.name = "spread", .form = Form::kNumber, .range = {0, 1e12}, .required = true, .text = "as that of a lobe"},
    Key{.name = "multiplier", .form = Form::kNumbers, .range = {0, 1e12}, .unit = "1/sr", .required = true, .text = "coefficient that the largest byte stands for, of each channel"},
    Key{.name = "factors", .form = Form::kNumbers, .range = {-1e12, 1e12}, .required = true, .text = "of each lobe, in their order"},
};
constexpr json::Section kMixSection{"mix", "A sum of lobes that all texels share.", kMixKeys};
constexpr std::array<const json::Section*, 1> kMixOnly{&kMixSection};
constexpr std::array kMetricKeys{
    Key{.name = "name", .form = Form::kText, .required = true, .text = "of the number"},
    Key{.name = "value", .form = Form::kNumber, .range = {-1e300, 1e300}, .required = true, .text = "what was measured"},
};
constexpr json::Section kMetricSection{"metric", "What the bake measured of itself.", kMetricKeys};
constexpr std::array<const json::Section*, 1> kMetricOnly{&kMetricSection};
constexpr std::array kBakeKeys{
    Key{.name = "type", .form = Form::kText, .required = true, .text = "\"realis bake\""},
    Key{.name = "version", .form = Form::kWhole, .range = {kBakeVersion, kBakeVersion}, .required = true, .text = "of the format"},
    Key{.name = "capture", .form = Form::kText, .text = "what was baked"},
    Key{.name = "camera", .form = Form::kText, .text = "whose picture is the texture"},
    Key{.name = "space", .form = Form::kChoice, .choices = kSpaces, .text = "what the pixels are: those of the camera's picture, or texels of the object"},
    Key{.name = "scene", .form = Form::kText, .text = "file that the object stands in"},
    Key{.name = "object", .form = Form::kText, .text = "instance whose texture was baked"},
    Key{.name = "scene_sha256", .form = Form::kText, .text = "of all of the scene that cameras may see"},
    Key{.name = "mesh_sha256", .form = Form::kText, .text = "of the object's triangles, positions and texture coordinates"},
    Key{.name = "width", .form = Form::kWhole, .range = {1, 65536}, .unit = "pixel", .required = true, .text = "of the pictures"},
    Key{.name = "height", .form = Form::kWhole, .range = {1, 65536}, .unit = "pixel", .required = true, .text = "of the pictures"},
    Key{.name = "channels", .form = Form::kChoice, .required = true, .choices = kChannels, .text = "one residual for all colors, or one each"},
    Key{.name = "storage", .form = Form::kChoice, .required = true, .choices = kStorages, .text = "of the coefficients: a number of that many bits says what share of its multiplier, of 4 bit and squared the square with its sign"},
    Key{.name = "floor", .form = Form::kNumber, .range = {0, 1}, .above = true, .required = true, .text = "what the cosine of light and normal counts for at least, when a residual is multiplied by it"},
    Key{.name = "kept", .form = Form::kWhole, .range = {0, kMostLobes}, .required = true, .text = "lobes of each texel that are not 0"},
    Key{.name = "lobes", .form = Form::kList, .required = true, .sections = kLobeOnly, .text = "shared by all texels"},
    Key{.name = "mixes", .form = Form::kList, .sections = kMixOnly, .text = "what coefficients are of, instead of the lobes themselves, whose spread and multiplier are 0 then"},
    Key{.name = "inputs", .form = Form::kNames, .text = "files that were read, and their SHA-256"},
    Key{.name = "metrics", .form = Form::kList, .sections = kMetricOnly, .text = "what the bake measured of itself"},
};
// clang-format on

}  // namespace

const json::Section kBakeSection{"bake", "A residual between photographs and renders: bake.json.", kBakeKeys};

std::string numbered(const char* name, std::size_t index) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%s_%03zu.png", name, index);
  return text.data();
}

}  // namespace likeness::baked
