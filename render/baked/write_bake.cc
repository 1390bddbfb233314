#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "render/baked/bake_file.h"
#include "render/baked/format.h"
#include "render/files/files.h"
#include "render/image/layers.h"
#include "render/image/write.h"

namespace likeness::baked {
namespace {

using Json = nlohmann::ordered_json;

// Planes of bytes over the picture, three a file; 0 elsewhere.
void write_planes(const std::filesystem::path& folder, const char* name, const StoredBake& head, std::size_t planes,
                  const std::function<std::vector<std::uint8_t>(std::size_t)>& bytes_of) {
  for (std::size_t first = 0; first < planes; first += 3) {
    image::DisplayPicture picture(head.width, head.height);
    for (std::size_t k = 0; k < 3 && first + k < planes; ++k) {
      const std::vector<std::uint8_t> bytes = bytes_of(first + k);
      for (std::size_t texel = 0; texel < bytes.size(); ++texel)
        picture.rgb[3 * std::size_t{head.pixels[texel]} + k] = bytes[texel];
    }
    image::write_png(folder / numbered(name, first / 3), picture);
  }
}

// Those of another bake: with fewer planes, or as floats, some would stay and say nothing.
void remove_pictures(const std::filesystem::path& folder) {
  std::filesystem::remove(folder / kFloats);
  for (const char* name : {"lobes", "coefficients"})
    for (std::size_t i = 0; std::filesystem::remove(folder / numbered(name, i)); ++i) {}
}

}  // namespace

std::vector<std::uint8_t> kept_lobes(std::span<const float> coefficients, std::size_t channels, std::size_t kept) {
  const std::size_t lobes = coefficients.size() / std::max<std::size_t>(channels, 1);
  std::vector<std::uint8_t> out;
  const auto is_used = [&](std::size_t k) {
    for (std::size_t ch = 0; ch < channels; ++ch)
      if (coefficients[ch * lobes + k] != 0) return true;
    return false;
  };
  for (const bool used : {true, false})
    for (std::size_t k = 0; k < lobes && out.size() < kept; ++k)
      if (is_used(k) == used) out.push_back(static_cast<std::uint8_t>(k));
  std::sort(out.begin(), out.end());
  return out;
}

void write_bake(const std::filesystem::path& folder, const StoredBake& stored, bool is_float) {
  const Bake& bake = stored.bake;
  const std::size_t lobes = bake.basis.size(), channels = bake.channel_count(), each = channels * lobes;
  std::vector<std::vector<std::uint8_t>> kept(bake.is_sparse() ? stored.pixels.size() : 0);
  for (std::size_t texel = 0; texel < kept.size(); ++texel)
    kept[texel] = kept_lobes(std::span(bake.coefficients).subspan(texel * each, each), channels, bake.kept);
  PlaneSource source;
  source.multipliers = multipliers_of(bake);
  source.coefficients = [&](std::size_t plane) {
    std::vector<float> out(stored.pixels.size());
    for (std::size_t texel = 0; texel < out.size(); ++texel) {
      const std::size_t at =
          kept.empty() ? plane : plane / bake.kept * lobes + std::size_t{kept[texel][plane % bake.kept]};
      out[texel] = bake.coefficients[texel * each + at];
    }
    return out;
  };
  source.lobes = [&](std::size_t place) {
    std::vector<std::uint8_t> out(kept.size());
    for (std::size_t texel = 0; texel < out.size(); ++texel) out[texel] = kept[texel][place];
    return out;
  };
  write_bake(folder, stored, source, is_float);
}

void write_bake(const std::filesystem::path& folder, const StoredBake& stored, const PlaneSource& source,
                bool is_float) {
  const Bake& bake = stored.bake;
  const std::size_t lobes = bake.basis.size(), channels = bake.channel_count(), each = channels * lobes;
  const bool is_four = bake.bits == Bits::kFour && !is_float;
  const std::vector<double>& multipliers = source.multipliers;
  std::filesystem::create_directories(folder);
  std::filesystem::remove(folder / kBakeFile);  // a bake without it is none: whoever reads meanwhile is told so
  remove_pictures(folder);
  if (is_float) {
    // The file has a plane for each lobe.
    image::Layers layers{stored.width, stored.height, {}, {}};
    const std::size_t count = static_cast<std::size_t>(stored.width) * static_cast<std::size_t>(stored.height);
    for (std::size_t plane = 0; plane < each; ++plane) {
      std::array<char, 32> name{};
      std::snprintf(name.data(), name.size(), "c%05zu", plane);
      layers.layers.push_back({name.data(), {"Y"}, std::vector<float>(count)});
    }
    for (std::size_t plane = 0; plane < (bake.is_sparse() ? channels * bake.kept : each); ++plane) {
      const std::vector<float> values = source.coefficients(plane);
      const std::vector<std::uint8_t> of =
          bake.is_sparse() ? source.lobes(plane % bake.kept) : std::vector<std::uint8_t>();
      for (std::size_t texel = 0; texel < values.size(); ++texel)
        layers.layers[bake.is_sparse() ? plane / bake.kept * lobes + of[texel] : plane].data[stored.pixels[texel]] =
            values[texel];
    }
    if (!layers.layers.empty()) image::write_layers(folder / kFloats, layers);
  } else if (is_four) {
    // Two a byte, the first in its upper half; below a last one that is alone is the nibble of 0.
    const auto nibbles_of = [&](std::size_t plane) {
      const std::vector<float> values = source.coefficients(plane);
      std::vector<std::uint8_t> out(values.size());
      for (std::size_t texel = 0; texel < out.size(); ++texel)
        out[texel] = stored_of(static_cast<double>(values[texel]), multipliers[plane], bake.bits);
      return out;
    };
    write_planes(folder, "coefficients", stored, (each + 1) / 2, [&](std::size_t pair) {
      std::vector<std::uint8_t> out = nibbles_of(2 * pair);
      for (std::uint8_t& byte : out) byte = static_cast<std::uint8_t>(byte << 4 | kNibbleZero);
      if (2 * pair + 1 == each) return out;
      const std::vector<std::uint8_t> lower = nibbles_of(2 * pair + 1);
      for (std::size_t texel = 0; texel < out.size(); ++texel)
        out[texel] = static_cast<std::uint8_t>((out[texel] & 0xf0) | lower[texel]);
      return out;
    });
  } else {
    if (bake.is_sparse()) write_planes(folder, "lobes", stored, bake.kept, source.lobes);
    write_planes(folder, "coefficients", stored, channels * bake.kept, [&](std::size_t plane) {
      const std::vector<float> values = source.coefficients(plane);
      const std::vector<std::uint8_t> of =
          bake.is_sparse() ? source.lobes(plane % bake.kept) : std::vector<std::uint8_t>();
      std::vector<std::uint8_t> out(values.size());
      for (std::size_t texel = 0; texel < out.size(); ++texel)
        out[texel] =
            stored_of(static_cast<double>(values[texel]),
                      multipliers[bake.is_sparse() ? plane / bake.kept * lobes + of[texel] : plane], bake.bits);
      return out;
    });
  }
  Json out;
  out["type"] = kBakeType, out["version"] = kBakeVersion;
  out["capture"] = stored.about.capture, out["camera"] = stored.about.camera;
  out["space"] = kSpaces[static_cast<std::size_t>(stored.about.space)];
  if (stored.about.space == Space::kTexture) {
    out["scene"] = stored.about.scene, out["object"] = stored.about.object;
    out["scene_sha256"] = stored.about.scene_sha256, out["mesh_sha256"] = stored.about.mesh_sha256;
  }
  out["width"] = stored.width, out["height"] = stored.height;
  out["channels"] = kChannels[static_cast<std::size_t>(bake.channels)];
  out["storage"] = is_float ? kStorages[1] : kStorages[bake.bits == Bits::kEight ? 0 : is_four ? 2 : 3];
  out["floor"] = bake.floor, out["kept"] = bake.kept;
  Json& rows = out["lobes"] = Json::array();
  const bool is_mixed = !bake.basis.mix.empty();
  for (std::size_t k = 0; k < bake.basis.lobes.size(); ++k) {
    const Lobe& lobe = bake.basis.lobes[k];
    Json row;
    row["axis"] = {lobe.axis.x, lobe.axis.y, lobe.axis.z}, row["sharpness"] = lobe.sharpness;
    row["spread"] = is_mixed ? 0 : bake.basis.spread[k];
    for (std::size_t c = 0; c < channels; ++c) row["multiplier"].push_back(is_mixed ? 0 : multipliers[c * lobes + k]);
    rows.push_back(std::move(row));
  }
  for (std::size_t k = 0; is_mixed && k < lobes; ++k) {
    Json row;
    row["spread"] = bake.basis.spread[k];
    for (std::size_t c = 0; c < channels; ++c) row["multiplier"].push_back(multipliers[c * lobes + k]);
    const auto factors = bake.basis.mix.begin() + static_cast<std::ptrdiff_t>(k * bake.basis.lobes.size());
    row["factors"] = std::vector<double>(factors, factors + static_cast<std::ptrdiff_t>(bake.basis.lobes.size()));
    out["mixes"].push_back(std::move(row));
  }
  Json& inputs = out["inputs"] = Json::object();
  for (const auto& [file, hash] : stored.about.inputs) inputs[file] = hash;
  Json& metrics = out["metrics"] = Json::array();
  for (const auto& [name, value] : stored.about.metrics) metrics.push_back({{"name", name}, {"value", value}});
  files::write_whole(folder / kBakeFile, out.dump(1) + "\n");
}

}  // namespace likeness::baked
