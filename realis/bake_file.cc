#include "realis/bake_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "brdf/realis/coefficient.h"
#include "render/files/files.h"
#include "render/image/layers.h"
#include "render/image/read.h"
#include "render/image/write.h"
#include "render/json/fields.h"

namespace likeness::realis {
namespace {

using Json = nlohmann::ordered_json;
using json::Form;
using json::Key;
using Words = std::string_view;

constexpr std::array<Words, 2> kChannels{"luminance", "rgb"};
constexpr std::array<Words, 2> kStorages{"8 bit", "float"};
constexpr const char *kFile = "bake.json", *kFloats = "coefficients.exr", *kType = "realis bake";

// clang-format off
constexpr std::array kLobeKeys{
    Key{.name = "axis", .form = Form::kVector, .required = true, .text = "of the lobe, in the world's axes; unit"},
    Key{.name = "sharpness", .form = Form::kNumber, .range = {0, 1e6}, .required = true, .text = "of its Gaussian"},
    Key{.name = "spread", .form = Form::kNumber, .range = {0, 1e12}, .required = true, .text = "standard deviation that its coefficients had before anything was seen, over that of a sample"},
    Key{.name = "multiplier", .form = Form::kNumbers, .range = {0, 1e12}, .unit = "1/sr", .required = true, .text = "coefficient that 127 stands for, of each channel"},
};
constexpr json::Section kLobeSection{"lobe", "A windowed spherical Gaussian that all texels share.", kLobeKeys};
constexpr std::array<const json::Section*, 1> kLobeOnly{&kLobeSection};
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
    Key{.name = "width", .form = Form::kWhole, .range = {1, 65536}, .unit = "pixel", .required = true, .text = "of the pictures"},
    Key{.name = "height", .form = Form::kWhole, .range = {1, 65536}, .unit = "pixel", .required = true, .text = "of the pictures"},
    Key{.name = "channels", .form = Form::kChoice, .required = true, .choices = kChannels, .text = "one residual for all colors, or one each"},
    Key{.name = "storage", .form = Form::kChoice, .required = true, .choices = kStorages, .text = "of the coefficients"},
    Key{.name = "floor", .form = Form::kNumber, .range = {0, 1}, .above = true, .required = true, .text = "what the cosine of light and normal counts for at least, when a residual is multiplied by it"},
    Key{.name = "kept", .form = Form::kWhole, .range = {0, kMostLobes}, .required = true, .text = "lobes of each texel that are not 0"},
    Key{.name = "lobes", .form = Form::kList, .required = true, .sections = kLobeOnly, .text = "shared by all texels"},
    Key{.name = "inputs", .form = Form::kNames, .text = "files that were read, and their SHA-256"},
    Key{.name = "metrics", .form = Form::kList, .sections = kMetricOnly, .text = "what the bake measured of itself"},
};
// clang-format on

std::string numbered(const char* name, std::size_t index) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%s_%03zu.png", name, index);
  return text.data();
}

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

bool is_sparse(const Bake& bake) { return bake.kept < bake.basis.lobes.size(); }

// The largest coefficient of each channel and lobe, channel by channel.
std::vector<double> multipliers_of(const Bake& bake) {
  const std::size_t each = bake.channel_count() * bake.basis.lobes.size();
  std::vector<double> out(each, 0.0);
  for (std::size_t i = 0; i < bake.coefficients.size(); ++i)
    out[i % each] = std::max(out[i % each], static_cast<double>(std::abs(bake.coefficients[i])));
  return out;
}
std::uint8_t byte_of(float c, double multiplier) { return brdf::encoded(static_cast<double>(c), multiplier); }
float coefficient_of(std::uint8_t byte, double multiplier) {
  return static_cast<float>(brdf::decoded(static_cast<double>(byte), multiplier));
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

// The planes that write_planes() wrote, each of all pixels.
std::vector<std::vector<std::uint8_t>> read_planes(const std::filesystem::path& folder, const char* name, int width,
                                                   int height, std::size_t planes) {
  std::vector<std::vector<std::uint8_t>> out(planes);
  for (std::size_t first = 0; first < planes; first += 3) {
    const std::filesystem::path file = folder / numbered(name, first / 3);
    const image::Texels texels = image::read_texels(file);
    if (texels.width != width || texels.height != height || texels.channels != 3 || texels.bytes.empty())
      throw files::InputError(file.string() + ": is " + std::to_string(texels.width) + " x " +
                              std::to_string(texels.height) + " of " + std::to_string(texels.channels) +
                              " channels; expected " + std::to_string(width) + " x " + std::to_string(height) +
                              " of 3 with 8 bits, as bake.json says");
    for (std::size_t k = 0; k < 3 && first + k < planes; ++k) {
      out[first + k].resize(texels.count());
      for (std::size_t i = 0; i < texels.count(); ++i) out[first + k][i] = texels.bytes[3 * i + k];
    }
  }
  return out;
}

void read_floats(const std::filesystem::path& file, std::size_t each, StoredBake& out) {
  const image::Layers layers = image::read_layers(file);
  const auto count = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
  if (layers.width != out.width || layers.height != out.height || layers.layers.size() != each)
    throw files::InputError(file.string() + ": holds " + std::to_string(layers.layers.size()) + " layers of " +
                            std::to_string(layers.width) + " x " + std::to_string(layers.height) + "; expected " +
                            std::to_string(each) + " of " + std::to_string(out.width) + " x " +
                            std::to_string(out.height) + ", as bake.json says");
  out.pixels.resize(count);
  for (std::size_t i = 0; i < count; ++i) out.pixels[i] = static_cast<std::uint32_t>(i);
  out.bake.coefficients.resize(count * each);
  for (std::size_t plane = 0; plane < each; ++plane) {
    const std::vector<float>& data = layers.layers[plane].data;
    if (data.size() != count) throw files::InputError(file.string() + ": a layer has several channels; expected one");
    for (std::size_t i = 0; i < count; ++i) {
      if (!std::isfinite(data[i]))
        throw files::InputError(file.string() + ": a coefficient is not finite (pixel " + std::to_string(i) + ")");
      out.bake.coefficients[i * each + plane] = data[i];
    }
  }
}

void read_bytes(const std::filesystem::path& folder, const std::vector<double>& multipliers, StoredBake& out) {
  Bake& bake = out.bake;
  const std::size_t lobes = bake.basis.lobes.size(), channels = bake.channel_count(), each = channels * lobes;
  const bool sparse = is_sparse(bake);
  const auto planes = read_planes(folder, "coefficients", out.width, out.height, channels * bake.kept);
  const auto which = read_planes(folder, "lobes", out.width, out.height, sparse ? bake.kept : 0);
  if (planes.empty()) return;
  for (std::size_t i = 0; i < planes[0].size(); ++i)
    if (planes[0][i] != 0) out.pixels.push_back(static_cast<std::uint32_t>(i));
  bake.coefficients.assign(out.pixels.size() * each, 0.0f);
  for (std::size_t texel = 0; texel < out.pixels.size(); ++texel)
    for (std::size_t plane = 0; plane < planes.size(); ++plane) {
      const std::size_t pixel = out.pixels[texel];
      const std::size_t lobe = sparse ? which[plane % bake.kept][pixel] : plane % lobes;
      if (lobe >= lobes)
        throw files::InputError((folder / numbered("lobes", plane % bake.kept / 3)).string() + ": pixel " +
                                std::to_string(pixel) + " names lobe " + std::to_string(lobe) + "; bake.json has " +
                                std::to_string(lobes));
      const std::size_t at = plane / bake.kept * lobes + lobe;
      bake.coefficients[texel * each + at] = coefficient_of(planes[plane][pixel], multipliers[at]);
    }
}

}  // namespace

const json::Section kBakeSection{"bake", "A residual between photographs and renders: bake.json.", kBakeKeys};

std::size_t bytes_of_texel(const Bake& bake) {
  return bake.kept * bake.channel_count() + (is_sparse(bake) ? bake.kept : 0);
}

Bake quantised(const Bake& bake) {
  Bake out = bake;
  const std::vector<double> multipliers = multipliers_of(bake);
  for (std::size_t i = 0; i < out.coefficients.size(); ++i) {
    const double m = multipliers[i % multipliers.size()];
    out.coefficients[i] = coefficient_of(byte_of(bake.coefficients[i], m), m);
  }
  return out;
}

void write_bake(const std::filesystem::path& folder, const StoredBake& stored, bool is_float) {
  const Bake& bake = stored.bake;
  const std::size_t lobes = bake.basis.lobes.size(), channels = bake.channel_count(), each = channels * lobes;
  const std::vector<double> multipliers = multipliers_of(bake);
  std::filesystem::create_directories(folder);
  std::filesystem::remove(folder / kFile);  // a bake without it is none: whoever reads meanwhile is told so
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
  } else if (is_sparse(bake)) {
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
  out["type"] = kType, out["version"] = kBakeVersion;
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
  files::write_whole(folder / kFile, out.dump(1) + "\n");
}

StoredBake read_bake(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kFile;
  const std::string source = file.string();
  const json::Value value = json::parse(files::read_whole(file, kMostBakeBytes), source);
  const json::Fields fields(source, value, kBakeSection, "");
  if (fields.text("type") != kType)
    fields.refuse("type", " = " + files::in_quotes(fields.text("type")) + "; expected \"" + kType + "\"");
  StoredBake out;
  out.about.capture = fields.text("capture"), out.about.camera = fields.text("camera");
  out.width = fields.whole("width"), out.height = fields.whole("height");
  if (static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) > image::kMostTexels)
    fields.refuse("width", " and height make too many pixels");
  Bake& bake = out.bake;
  bake.channels = fields.text("channels") == kChannels[1] ? Channels::kRgb : Channels::kLuminance;
  bake.floor = fields.number("floor");
  const std::size_t channels = bake.channel_count();
  const std::vector<json::Fields> rows = fields.list("lobes");
  if (rows.size() > kMostLobes)
    fields.refuse("lobes", " are " + std::to_string(rows.size()) + "; expected at most " + std::to_string(kMostLobes));
  std::vector<double> multipliers(channels * rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    bake.basis.lobes.push_back({rows[k].direction("axis"), rows[k].number("sharpness")});
    bake.basis.spread.push_back(rows[k].number("spread"));
    const std::vector<double> each = rows[k].numbers("multiplier");
    if (each.size() != channels)
      rows[k].refuse("multiplier", " has " + std::to_string(each.size()) + " numbers; expected " +
                                       std::to_string(channels) + ", one a channel");
    for (std::size_t c = 0; c < channels; ++c) multipliers[c * rows.size() + k] = each[c];
  }
  bake.kept = static_cast<std::size_t>(fields.whole("kept"));
  if (bake.kept > rows.size())
    fields.refuse("kept", " = " + std::to_string(bake.kept) + " is more than there are lobes (" +
                              std::to_string(rows.size()) + ")");
  for (const json::Fields& row : fields.list("metrics"))
    out.about.metrics.emplace_back(row.text("name"), row.number("value"));
  if (fields.text("storage") == kStorages[1]) read_floats(folder / kFloats, channels * rows.size(), out);
  else read_bytes(folder, multipliers, out);
  return out;
}

}  // namespace likeness::realis
