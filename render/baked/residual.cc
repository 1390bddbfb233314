#include "render/baked/residual.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "brdf/realis/coefficient.h"
#include "render/baked/format.h"
#include "render/files/files.h"

namespace likeness::baked {
namespace {

using brdf::kRealisDominant;
using brdf::kRealisZero;

constexpr double kMostMultiplier = 1e12;

// A lobe of a texel, with its byte in each channel.
struct Slot {
  std::uint8_t lobe = 0;
  std::array<std::uint8_t, 3> bytes{kRealisZero, kRealisZero, kRealisZero};
  double size = 0;  // of its largest coefficient [1/sr]
};

// The lobes of a pixel that are not 0; none where nothing is known.
void slots_of(const Header& header, const Planes& planes, std::size_t pixel, std::vector<Slot>& out) {
  const std::size_t lobes = header.bake.basis.lobes.size(), channels = header.bake.channel_count();
  out.clear();
  if (header.is_float) {
    for (std::size_t k = 0; k < lobes; ++k) {
      Slot slot{static_cast<std::uint8_t>(k)};
      for (std::size_t c = 0; c < channels; ++c)
        slot.bytes[c] =
            brdf::encoded(static_cast<double>(planes.floats[c * lobes + k][pixel]), header.multipliers[c * lobes + k]);
      out.push_back(slot);
    }
  } else if (!planes.coefficients.empty() && planes.coefficients[0][pixel] != 0) {
    for (std::size_t k = 0; k < header.bake.kept; ++k) {
      Slot slot{planes.lobes.empty() ? static_cast<std::uint8_t>(k) : planes.lobes[k][pixel]};
      for (std::size_t c = 0; c < channels; ++c) slot.bytes[c] = planes.coefficients[c * header.bake.kept + k][pixel];
      out.push_back(slot);
    }
  }
  for (Slot& slot : out)
    for (std::size_t c = 0; c < channels; ++c)
      slot.size = std::max(slot.size,
                           std::abs(slot.bytes[c] - kRealisZero) / 127.0 * header.multipliers[c * lobes + slot.lobe]);
  std::erase_if(out, [](const Slot& slot) { return !(slot.size > 0); });
  std::stable_sort(out.begin(), out.end(), [](const Slot& a, const Slot& b) { return a.size > b.size; });
}

template <std::size_t kChannels>
void fill(const Header& header, const Planes& planes, std::size_t groups,
          std::vector<brdf::RealisTexel<kChannels>>& out) {
  out.resize(header.count() * groups);
  std::vector<Slot> slots;
  for (std::size_t pixel = 0; pixel < header.count(); ++pixel) {
    slots_of(header, planes, pixel, slots);
    const std::size_t used = std::min(slots.size(), groups * kRealisDominant);
    for (std::size_t i = 0; i < used; ++i) {
      brdf::RealisTexel<kChannels>& texel = out[pixel * groups + i / kRealisDominant];
      texel.lobes[i % kRealisDominant] = slots[i].lobe;
      for (std::size_t c = 0; c < kChannels; ++c) texel.coefficients[c][i % kRealisDominant] = slots[i].bytes[c];
    }
  }
}

// The byte of a coefficient that is 0 [of Bits].
std::uint8_t zero_of(const Bake& bake) { return bake.bits == Bits::kFour ? kNibbleZero : brdf::kRealisZero; }

void place_mixes(const Header& header, double exposure, Residual& out) {
  const Basis& basis = header.bake.basis;
  std::vector<brdf::Vec3<double>> axes;
  std::vector<double> sharpnesses, mix = basis.mix;
  for (const Lobe& lobe : basis.lobes) axes.emplace_back(lobe.axis), sharpnesses.push_back(lobe.sharpness);
  if (mix.empty()) {  // each lobe is a mix of its own
    mix.assign(axes.size() * axes.size(), 0.0);
    for (std::size_t k = 0; k < axes.size(); ++k) mix[k * axes.size() + k] = 1;
  }
  out.mixes.place(axes, sharpnesses, mix);
  for (std::size_t c = 0; c < out.channels; ++c)
    for (std::size_t j = 0; j < out.mixes.count; ++j)
      out.mixes.scale[c][j] =
          static_cast<float>(std::min(header.multipliers[c * out.mixes.count + j] / exposure, kMostMultiplier));
  for (int byte = 0; byte < 256; ++byte) {
    const auto b = static_cast<std::uint8_t>(byte);
    const std::uint8_t most = header.bake.bits == Bits::kFour ? 15 : 255;
    out.mixes.decoded[b] = static_cast<float>(worth_of(std::min(b, most), 1.0, header.bake.bits));
  }
}

void fill_mixed(const Header& header, const Planes& planes, Residual& out) {
  const std::size_t mixes = out.mixes.count, each = out.channels * mixes;
  out.mixed.assign(header.count() * each, zero_of(header.bake));
  for (std::size_t pixel = 0; pixel < header.count(); ++pixel) {
    std::uint8_t* const bytes = out.mixed.data() + pixel * each;
    if (header.is_float) {
      for (std::size_t k = 0; k < each; ++k)
        bytes[k] = brdf::encoded(static_cast<double>(planes.floats[k][pixel]), header.multipliers[k]);
    } else if (planes.coefficients[0][pixel] != 0) {
      for (std::size_t plane = 0; plane < planes.coefficients.size(); ++plane) {
        const std::size_t slot = plane % header.bake.kept;
        const std::size_t mix = planes.lobes.empty() ? slot : std::size_t{planes.lobes[slot][pixel]};
        bytes[plane / header.bake.kept * mixes + mix] = planes.coefficients[plane][pixel];
      }
    }
  }
}

}  // namespace

std::size_t Residual::bytes() const {
  return luminance.size() * sizeof(brdf::RealisTexel<1>) + rgb.size() * sizeof(brdf::RealisTexel<3>) + mixed.size() +
         mixes.values.size() * sizeof(float) +
         (surface ? 4 * (surface->normals.rgb.size() + surface->base_colors.rgb.size()) : 0);
}

Residual read_residual(const std::filesystem::path& folder, const Access& access) {
  const std::filesystem::path file = folder / kBakeFile;
  const Header header = parse_header(access.bytes(file, kMostBakeBytes), file.string());
  const bool is_mixed = !header.bake.basis.mix.empty() || header.bake.bits != Bits::kEight;
  if (is_mixed && header.bake.basis.size() > brdf::RealisMixes::kMost)
    throw files::InputError(file.string() + ": " + std::to_string(header.bake.basis.size()) +
                            " mixes (or lobes of 4 bit) are more than a renderer reads; at most " +
                            std::to_string(brdf::RealisMixes::kMost) + "; bake fewer: realis bake --mixes");
  Residual out;
  out.name = folder.lexically_normal().string();
  out.width = header.width, out.height = header.height;
  out.floor = static_cast<float>(header.bake.floor);
  out.lobe_count = is_mixed ? 0 : header.bake.basis.lobes.size();
  out.groups = is_mixed ? 0 : (header.bake.kept + kRealisDominant - 1) / kRealisDominant;
  out.channels = header.bake.channel_count();
  const bool is_rgb = out.is_rgb();
  const std::size_t each = is_mixed ? std::max<std::size_t>(out.channels * header.bake.basis.size(), 1)
                                    : std::max<std::size_t>(out.groups, 1) *
                                          (is_rgb ? sizeof(brdf::RealisTexel<3>) : sizeof(brdf::RealisTexel<1>));
  if (header.count() > kMostPlaneBytes / each)
    throw files::InputError(file.string() + ": " + std::to_string(header.count()) + " pixels of " +
                            std::to_string(each) + " bytes are more than a renderer reads; at most " +
                            std::to_string(kMostPlaneBytes) + " bytes");
  if (access.exists && access.exists(folder / kSurfaceFile)) {
    out.surface = read_surface(folder, access);
    if (out.surface->normals.width != out.width || out.surface->normals.height != out.height)
      throw files::InputError((folder / kSurfaceFile).string() + ": its pictures are " +
                              std::to_string(out.surface->normals.width) + " x " +
                              std::to_string(out.surface->normals.height) + ", those of bake.json " +
                              std::to_string(out.width) + " x " + std::to_string(out.height));
  }
  // What the photographs saw of a unit light is the model's times the exposure; the residual likewise.
  const double exposure = out.surface ? out.surface->exposure : 1;
  if (is_mixed) {
    place_mixes(header, exposure, out);
    if (out.mixes.count > 0 && header.bake.kept > 0) fill_mixed(header, read_planes(folder, header, access), out);
    return out;
  }
  for (std::size_t k = 0; k < out.lobe_count; ++k) {
    const Lobe& lobe = header.bake.basis.lobes[k];
    const auto multiplier = [&](std::size_t channel) {
      const double m = header.multipliers[(is_rgb ? channel : 0) * out.lobe_count + k] / exposure;
      return static_cast<float>(std::min(m, kMostMultiplier));
    };
    out.lobes.place(k, brdf::Vec3<float>(brdf::Vec3<double>(lobe.axis)), static_cast<float>(lobe.sharpness),
                    brdf::Rgb<float>(multiplier(0), multiplier(1), multiplier(2)));
  }
  if (out.groups == 0) return out;
  const Planes planes = read_planes(folder, header, access);
  if (is_rgb) fill<3>(header, planes, out.groups, out.rgb);
  else fill<1>(header, planes, out.groups, out.luminance);
  return out;
}

}  // namespace likeness::baked
