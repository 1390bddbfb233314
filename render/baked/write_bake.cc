#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "brdf/realis/coefficient.h"
#include "render/baked/bake_file.h"
#include "render/baked/format.h"
#include "render/files/files.h"
#include "render/image/layers.h"
#include "render/image/write.h"

namespace likeness::baked {
namespace {

using Json = nlohmann::ordered_json;

std::uint8_t byte_of(float c, double multiplier) { return brdf::encoded(static_cast<double>(c), multiplier); }

// The lobes that a texel keeps: those that are not 0 in some channel, in their order; fewer are filled up with others.
std::vector<std::uint8_t> kept_lobes(const Bake& bake, std::size_t texel) {
  const std::size_t lobes = bake.basis.lobes.size(), channels = bake.channel_count();
  const float* c = bake.coefficients.data() + texel * channels * lobes;
  std::vector<std::uint8_t> out;
  const auto is_used = [&](std::size_t k) {
    for (std::size_t ch = 0; ch < channels; ++ch)
      if (c[ch * lobes + k] != 0) return true;
    return false;
  };
  for (const bool used : {true, false})
    for (std::size_t k = 0; k < lobes && out.size() < bake.kept; ++k)
      if (is_used(k) == used) out.push_back(static_cast<std::uint8_t>(k));
  std::sort(out.begin(), out.end());
  return out;
}

// Planes of bytes over the picture, three a file.
void write_planes(const std::filesystem::path& folder, const char* name, int width, int height,
                  const std::vector<std::uint32_t>& pixels, std::size_t planes, std::uint8_t elsewhere,
                  const auto& byte_at) {
  for (std::size_t first = 0; first < planes; first += 3) {
    image::DisplayPicture picture(width, height);
    std::fill(picture.rgb.begin(), picture.rgb.end(), elsewhere);
    for (std::size_t texel = 0; texel < pixels.size(); ++texel)
      for (std::size_t k = 0; k < 3 && first + k < planes; ++k)
        picture.rgb[3 * std::size_t{pixels[texel]} + k] = byte_at(texel, first + k);
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

void write_bake(const std::filesystem::path& folder, const StoredBake& stored, bool is_float) {
  const Bake& bake = stored.bake;
  const std::size_t lobes = bake.basis.lobes.size(), channels = bake.channel_count(), each = channels * lobes;
  const std::vector<double> multipliers = multipliers_of(bake);
  std::filesystem::create_directories(folder);
  std::filesystem::remove(folder / kBakeFile);  // a bake without it is none: whoever reads meanwhile is told so
  remove_pictures(folder);
  if (is_float) {
    image::Layers layers{stored.width, stored.height, {}, {}};
    for (std::size_t plane = 0; plane < each; ++plane) {
      std::array<char, 32> name{};
      std::snprintf(name.data(), name.size(), "c%05zu", plane);
      image::Layer layer{
          name.data(),
          {"Y"},
          std::vector<float>(static_cast<std::size_t>(stored.width) * static_cast<std::size_t>(stored.height))};
      for (std::size_t texel = 0; texel < stored.pixels.size(); ++texel)
        layer.data[stored.pixels[texel]] = bake.coefficients[texel * each + plane];
      layers.layers.push_back(std::move(layer));
    }
    image::write_layers(folder / kFloats, layers);
  } else if (bake.is_sparse()) {
    std::vector<std::vector<std::uint8_t>> kept(stored.pixels.size());
    for (std::size_t texel = 0; texel < kept.size(); ++texel) kept[texel] = kept_lobes(bake, texel);
    write_planes(folder, "lobes", stored.width, stored.height, stored.pixels, bake.kept, 0,
                 [&](std::size_t texel, std::size_t k) { return kept[texel][k]; });
    write_planes(folder, "coefficients", stored.width, stored.height, stored.pixels, channels * bake.kept, 0,
                 [&](std::size_t texel, std::size_t plane) {
                   const std::size_t at = plane / bake.kept * lobes + kept[texel][plane % bake.kept];
                   return byte_of(bake.coefficients[texel * each + at], multipliers[at]);
                 });
  } else {
    write_planes(folder, "coefficients", stored.width, stored.height, stored.pixels, each, 0,
                 [&](std::size_t texel, std::size_t plane) {
                   return byte_of(bake.coefficients[texel * each + plane], multipliers[plane]);
                 });
  }
  Json out;
  out["type"] = kBakeType, out["version"] = kBakeVersion;
  out["capture"] = stored.about.capture, out["camera"] = stored.about.camera;
  out["width"] = stored.width, out["height"] = stored.height;
  out["channels"] = kChannels[static_cast<std::size_t>(bake.channels)];
  out["storage"] = kStorages[is_float ? 1 : 0];
  out["floor"] = bake.floor, out["kept"] = bake.kept;
  Json& rows = out["lobes"] = Json::array();
  for (std::size_t k = 0; k < lobes; ++k) {
    const Lobe& lobe = bake.basis.lobes[k];
    Json row;
    row["axis"] = {lobe.axis.x, lobe.axis.y, lobe.axis.z}, row["sharpness"] = lobe.sharpness;
    row["spread"] = bake.basis.spread[k];
    for (std::size_t c = 0; c < channels; ++c) row["multiplier"].push_back(multipliers[c * lobes + k]);
    rows.push_back(std::move(row));
  }
  Json& inputs = out["inputs"] = Json::object();
  for (const auto& [file, hash] : stored.about.inputs) inputs[file] = hash;
  Json& metrics = out["metrics"] = Json::array();
  for (const auto& [name, value] : stored.about.metrics) metrics.push_back({{"name", name}, {"value", value}});
  files::write_whole(folder / kBakeFile, out.dump(1) + "\n");
}

}  // namespace likeness::baked
