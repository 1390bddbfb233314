#include <cmath>

#include "render/baked/bake_file.h"
#include "render/baked/format.h"
#include "render/files/files.h"
#include "render/image/read.h"
#include "render/json/fields.h"

namespace likeness::baked {
namespace {

using Bytes = std::vector<std::uint8_t>;

// The planes of some pictures, each of all pixels.
std::vector<Bytes> read_bytes(const std::filesystem::path& folder, const char* name, const Header& header,
                              std::size_t planes, const Access& access) {
  std::vector<Bytes> out(planes);
  for (std::size_t first = 0; first < planes; first += 3) {
    const std::filesystem::path file = folder / numbered(name, first / 3);
    const image::Texels texels = access.texels(file, header.count());
    if (texels.width != header.width || texels.height != header.height || texels.channels != 3 || texels.bytes.empty())
      throw files::InputError(file.string() + ": is " + std::to_string(texels.width) + " x " +
                              std::to_string(texels.height) + " of " + std::to_string(texels.channels) +
                              " channels; expected " + std::to_string(header.width) + " x " +
                              std::to_string(header.height) + " of 3 with 8 bits, as bake.json says");
    for (std::size_t k = 0; k < 3 && first + k < planes; ++k) {
      out[first + k].resize(texels.count());
      for (std::size_t i = 0; i < texels.count(); ++i) out[first + k][i] = texels.bytes[3 * i + k];
    }
  }
  return out;
}

std::vector<std::vector<float>> read_floats(const std::filesystem::path& file, const Header& header,
                                            const Access& access) {
  const std::size_t planes = header.multipliers.size();
  image::Layers layers = access.layers(file, planes * header.count());
  if (layers.width != header.width || layers.height != header.height || layers.layers.size() != planes)
    throw files::InputError(file.string() + ": holds " + std::to_string(layers.layers.size()) + " layers of " +
                            std::to_string(layers.width) + " x " + std::to_string(layers.height) + "; expected " +
                            std::to_string(planes) + " of " + std::to_string(header.width) + " x " +
                            std::to_string(header.height) + ", as bake.json says");
  std::vector<std::vector<float>> out;
  for (image::Layer& layer : layers.layers) {
    if (layer.data.size() != header.count())
      throw files::InputError(file.string() + ": a layer has several channels; expected one");
    for (std::size_t i = 0; i < layer.data.size(); ++i)
      if (!std::isfinite(layer.data[i]))
        throw files::InputError(file.string() + ": a coefficient is not finite (pixel " + std::to_string(i) + ")");
    out.push_back(std::move(layer.data));
  }
  return out;
}

void refuse_sizes(const json::Fields& fields, const Header& header) {
  if (header.count() > image::kMostTexels) fields.refuse("width", " and height make too many pixels");
  const std::size_t planes = header.is_float ? 4 * header.multipliers.size()
                                             : header.planes() + (header.bake.is_sparse() ? header.bake.kept : 0);
  if (planes > 0 && header.count() > kMostPlaneBytes / planes)
    fields.refuse("width", ", height and kept lobes make " + std::to_string(header.count()) + " pixels of " +
                               std::to_string(planes) + " bytes; at most " + std::to_string(kMostPlaneBytes) +
                               " bytes are read");
}

void unpack_floats(const Planes& planes, StoredBake& out) {
  const std::size_t each = planes.floats.size(), count = out.pixels.size();
  for (std::size_t plane = 0; plane < each; ++plane)
    for (std::size_t i = 0; i < count; ++i) out.bake.coefficients[i * each + plane] = planes.floats[plane][i];
}

void unpack_bytes(const Planes& planes, const std::vector<double>& multipliers, StoredBake& out) {
  Bake& bake = out.bake;
  const std::size_t lobes = bake.basis.size(), each = multipliers.size();
  for (std::size_t texel = 0; texel < out.pixels.size(); ++texel)
    for (std::size_t plane = 0; plane < planes.coefficients.size(); ++plane) {
      const std::size_t pixel = out.pixels[texel], slot = plane % bake.kept;
      const std::size_t at =
          plane / bake.kept * lobes + (planes.lobes.empty() ? slot : std::size_t{planes.lobes[slot][pixel]});
      const std::uint8_t byte = planes.coefficients[plane][pixel];
      bake.coefficients[texel * each + at] = static_cast<float>(worth_of(byte, multipliers[at], bake.bits));
    }
}

}  // namespace

Header parse_header(std::string_view text, const std::string& source) {
  const json::Value value = json::parse(text, source);
  const json::Fields fields(source, value, kBakeSection, "");
  if (fields.text("type") != kBakeType)
    fields.refuse("type", " = " + files::in_quotes(fields.text("type")) + "; expected \"" + kBakeType + "\"");
  Header out;
  out.about.capture = fields.text("capture"), out.about.camera = fields.text("camera");
  if (fields.text("space") == kSpaces[1]) out.about.space = Space::kTexture;
  out.about.scene = fields.text("scene"), out.about.object = fields.text("object");
  out.about.scene_sha256 = fields.text("scene_sha256"), out.about.mesh_sha256 = fields.text("mesh_sha256");
  out.width = fields.whole("width"), out.height = fields.whole("height");
  out.is_float = fields.text("storage") == kStorages[1];
  Bake& bake = out.bake;
  bake.channels = fields.text("channels") == kChannels[1] ? Channels::kRgb : Channels::kLuminance;
  bake.floor = fields.number("floor");
  const std::size_t channels = bake.channel_count();
  const std::vector<json::Fields> rows = fields.list("lobes");
  if (rows.size() > kMostLobes)
    fields.refuse("lobes", " are " + std::to_string(rows.size()) + "; expected at most " + std::to_string(kMostLobes));
  out.multipliers.resize(channels * rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    bake.basis.lobes.push_back({rows[k].direction("axis"), rows[k].number("sharpness")});
    bake.basis.spread.push_back(rows[k].number("spread"));
    const std::vector<double> each = rows[k].numbers("multiplier");
    if (each.size() != channels)
      rows[k].refuse("multiplier", " has " + std::to_string(each.size()) + " numbers; expected " +
                                       std::to_string(channels) + ", one a channel");
    for (std::size_t c = 0; c < channels; ++c) out.multipliers[c * rows.size() + k] = each[c];
  }
  if (fields.text("storage") == kStorages[2]) bake.bits = Bits::kFour;
  if (fields.text("storage") == kStorages[3]) bake.bits = Bits::kEightSquared;
  const std::vector<json::Fields> mixes = fields.list("mixes");
  if (mixes.size() > kMostLobes)
    fields.refuse("mixes", " are " + std::to_string(mixes.size()) + "; expected at most " + std::to_string(kMostLobes));
  if (!mixes.empty()) {
    bake.basis.spread.clear();
    out.multipliers.resize(channels * mixes.size());
  }
  for (std::size_t k = 0; k < mixes.size(); ++k) {
    bake.basis.spread.push_back(mixes[k].number("spread"));
    const std::vector<double> each = mixes[k].numbers("multiplier"), factors = mixes[k].numbers("factors");
    if (each.size() != channels || factors.size() != rows.size())
      mixes[k].refuse("factors", ": a mix has a multiplier a channel (" + std::to_string(channels) +
                                     ") and a factor a lobe (" + std::to_string(rows.size()) + ")");
    for (std::size_t c = 0; c < channels; ++c) out.multipliers[c * mixes.size() + k] = each[c];
    bake.basis.mix.insert(bake.basis.mix.end(), factors.begin(), factors.end());
  }
  bake.kept = static_cast<std::size_t>(fields.whole("kept"));
  if (bake.bits == Bits::kFour && bake.kept != bake.basis.size())
    fields.refuse("kept", " = " + std::to_string(bake.kept) + "; with 4 bit all are kept (" +
                              std::to_string(bake.basis.size()) + ")");
  if (bake.kept > bake.basis.size())
    fields.refuse("kept", " = " + std::to_string(bake.kept) + " is more than there are lobes (" +
                              std::to_string(bake.basis.size()) + ")");
  for (const json::Fields& row : fields.list("metrics"))
    out.about.metrics.emplace_back(row.text("name"), row.number("value"));
  refuse_sizes(fields, out);
  return out;
}

Planes read_planes(const std::filesystem::path& folder, const Header& header, const Access& access) {
  Planes out;
  if (header.is_float) {
    if (!header.multipliers.empty()) out.floats = read_floats(folder / kFloats, header, access);
    return out;
  }
  if (header.bake.bits == Bits::kFour) {
    const std::vector<Bytes> pairs = read_bytes(folder, "coefficients", header, (header.planes() + 1) / 2, access);
    for (std::size_t plane = 0; plane < header.planes(); ++plane) {
      Bytes nibbles = pairs[plane / 2];
      for (std::uint8_t& byte : nibbles) byte = plane % 2 == 0 ? byte >> 4 : byte & 0x0f;
      out.coefficients.push_back(std::move(nibbles));
    }
    return out;
  }
  out.coefficients = read_bytes(folder, "coefficients", header, header.planes(), access);
  if (!header.bake.is_sparse()) return out;
  out.lobes = read_bytes(folder, "lobes", header, header.bake.kept, access);
  const std::size_t lobes = header.bake.basis.size();
  for (std::size_t k = 0; k < out.lobes.size(); ++k)
    for (std::size_t pixel = 0; pixel < out.lobes[k].size(); ++pixel)
      if (out.coefficients[0][pixel] != 0 && out.lobes[k][pixel] >= lobes)
        throw files::InputError((folder / numbered("lobes", k / 3)).string() + ": pixel " + std::to_string(pixel) +
                                " names lobe " + std::to_string(out.lobes[k][pixel]) + "; bake.json has " +
                                std::to_string(lobes));
  return out;
}

StoredBake read_bake(const std::filesystem::path& folder, const Access& access) {
  const std::filesystem::path file = folder / kBakeFile;
  Header header = parse_header(access.bytes(file, kMostBakeBytes), file.string());
  const Planes planes = read_planes(folder, header, access);
  StoredBake out{std::move(header.bake), std::move(header.about), header.width, header.height, {}};
  for (std::size_t i = 0; i < header.count(); ++i)
    if (header.is_float ? !planes.floats.empty() : !planes.coefficients.empty() && planes.coefficients[0][i] != 0)
      out.pixels.push_back(static_cast<std::uint32_t>(i));
  if (!out.pixels.empty() && header.multipliers.size() > kMostCoefficients / out.pixels.size())
    throw files::InputError(file.string() + ": " + std::to_string(out.pixels.size()) + " texels of " +
                            std::to_string(header.multipliers.size()) + " coefficients are too many; at most " +
                            std::to_string(kMostCoefficients) + " in all are read");
  out.bake.coefficients.assign(out.pixels.size() * header.multipliers.size(), 0.0f);
  if (header.is_float) unpack_floats(planes, out);
  else unpack_bytes(planes, header.multipliers, out);
  return out;
}

}  // namespace likeness::baked
