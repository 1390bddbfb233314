#include "render/baked/surface_maps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/baked/format.h"
#include "render/files/files.h"
#include "render/image/read.h"
#include "render/image/tone_curve.h"
#include "render/json/fields.h"
#include "render/material/material_file.h"

namespace likeness::baked {
namespace {

using json::Form;
using json::Key;

constexpr std::size_t kMostBytes = 1 << 16;
constexpr std::array kKeys{
    Key{.name = "scale",
        .form = Form::kNumber,
        .range = {0, 1e9},
        .required = true,
        .text = "base color that 255 stands for"},
    Key{.name = "exposure",
        .form = Form::kNumber,
        .range = {0, 1e9},
        .above = true,
        .required = true,
        .text = "photo over what the material returns of a unit light"},
    Key{.name = "spread", .form = Form::kNumber, .range = {0, 1}, .text = "of cosines within a pixel"},
    Key{.name = "least",
        .form = Form::kNumber,
        .range = {0, 1},
        .text = "light, over what a texel that faces it returns"},
};
constexpr json::Section kSection{"surface", "What a bake's renders were made of.", kKeys};

// The two pictures back, into `surface`.
void unpack(const ThinSurface& thin, Surface& surface) {
  surface.normals = image::Picture(thin.normals.width, thin.normals.height);
  surface.base_colors = image::Picture(thin.colors.width, thin.colors.height);
  for (std::size_t pixel = 0; pixel < surface.normals.rgb.size() / 3; ++pixel) {
    std::array<double, 3> n{};
    double length = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      n[k] = (static_cast<int>(thin.normals.rgb[3 * pixel + k]) - 128) / 127.0;
      length += n[k] * n[k];
    }
    length = std::sqrt(length);
    for (std::size_t k = 0; k < 3; ++k) {
      surface.normals.rgb[3 * pixel + k] = length > 0 ? static_cast<float>(n[k] / length) : 0.0f;
      surface.base_colors.rgb[3 * pixel + k] =
          static_cast<float>(thin.scale * image::srgb_decode8(thin.colors.rgb[3 * pixel + k]));
    }
  }
}

image::DisplayPicture read_bytes(const std::filesystem::path& file, const Access& access) {
  image::Texels texels = access.texels(file, image::kMostTexels);
  if (texels.channels != 3 || texels.bytes.empty())
    throw files::InputError(file.string() + ": has " + std::to_string(texels.channels) +
                            " channels, or not 8 bits; expected RGB of 8 bits, as `likeness realis bake` writes it");
  image::DisplayPicture out;
  out.width = texels.width, out.height = texels.height;
  out.rgb = std::move(texels.bytes);
  return out;
}

}  // namespace

ThinSurface packed(const Surface& surface) {
  ThinSurface out{
      {surface.normals.width, surface.normals.height}, {surface.base_colors.width, surface.base_colors.height}, 0};
  for (const float c : surface.base_colors.rgb) out.scale = std::max(out.scale, static_cast<double>(c));
  for (std::size_t i = 0; i < surface.normals.rgb.size(); ++i) {
    const double n = std::clamp(static_cast<double>(surface.normals.rgb[i]), -1.0, 1.0);
    out.normals.rgb[i] = static_cast<std::uint8_t>(128 + std::lround(127 * n));
    const double c = out.scale > 0 ? static_cast<double>(surface.base_colors.rgb[i]) / out.scale : 0;
    out.colors.rgb[i] = image::srgb_encode8(static_cast<float>(std::max(c, 0.0)));
  }
  return out;
}

Surface thin(const Surface& surface) {
  constexpr int kMostRounds = 16;
  Surface out = surface;
  ThinSurface stored = packed(surface);
  for (int round = 0; round < kMostRounds; ++round) {
    unpack(stored, out);
    // A normal that was made unit may round to other bytes than those it came from.
    ThinSurface again = packed(out);
    if (again.normals.rgb == stored.normals.rgb && again.colors.rgb == stored.colors.rgb) break;
    stored = std::move(again);
  }
  return out;
}

Surface read_surface(const std::filesystem::path& folder, const Access& access) {
  const std::string source = (folder / kSurfaceFile).string();
  const json::Value value = json::parse(access.bytes(folder / kSurfaceFile, kMostBytes), source);
  const json::Fields fields(source, value, kSection, "");
  Surface out;
  out.exposure = fields.number("exposure");
  out.spread = fields.number("spread"), out.least = fields.number("least");
  const std::filesystem::path file = folder / kMaterial;
  const material::Material read = material::material_of(access.bytes(file, material::kLargestFile), file.string());
  const auto* callisto = std::get_if<brdf::Callisto<double>>(&read.brdf);
  if (callisto == nullptr)
    throw files::InputError(file.string() + ": is not of the model callisto, as a bake's surface is");
  out.material = *callisto;
  const ThinSurface pictures{read_bytes(folder / kNormals, access), read_bytes(folder / kColors, access),
                             fields.number("scale")};
  if (pictures.normals.width != pictures.colors.width || pictures.normals.height != pictures.colors.height)
    throw files::InputError((folder / kColors).string() + ": is of another size than normal.png beside it");
  unpack(pictures, out);
  return out;
}

}  // namespace likeness::baked
