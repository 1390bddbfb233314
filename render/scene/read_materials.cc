#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/files/files.h"
#include "render/material/material_file.h"
#include "render/material/parameters.h"
#include "render/scene/mesh_file.h"
#include "render/scene/read_entries.h"

namespace likeness::scene {
namespace {

using json::Value;

struct Purpose {
  bool is_color = false, is_light = false;
};

Texture texture_of(const Fields& fields, Purpose purpose, const std::filesystem::path& folder, Loading& loading) {
  Texture out;
  out.image = loading.image(folder / fields.text("file"), purpose.is_light);
  const int channels = loading.scene().images[out.image].texels.channels;
  const std::string channel = fields.text("channel");
  out.channel = channel == "r" ? 0 : channel == "g" ? 1 : channel == "b" ? 2 : 3;
  if (purpose.is_color) {
    if (fields.has("channel"))
      fields.refuse("channel", " = " + files::in_quotes(channel) + ", but a color takes red, green and blue");
  } else if (out.channel == 3 && channels % 2 == 0) {
    out.channel = channels - 1;  // of grey and alpha, the second
  } else if (out.channel >= channels) {
    // Grey is red, green and blue alike.
    if (out.channel == 3 || channels > 2)
      fields.refuse("channel", " = " + files::in_quotes(channel) + ", but the picture has " + std::to_string(channels) +
                                   (channels == 1 ? " channel" : " channels"));
    out.channel = 0;
  } else if (channels == 2) {
    out.channel = 0;
  }
  const std::string transfer = fields.text("transfer");
  out.transfer = transfer.empty() ? (purpose.is_color ? Transfer::kSrgb : Transfer::kLinear)
                                  : (transfer == "srgb" ? Transfer::kSrgb : Transfer::kLinear);
  out.wrap = fields.text("wrap") == "clamp" ? Wrap::kClamp : Wrap::kRepeat;
  out.uv_scale = fields.pair("uv_scale");
  out.uv_offset = fields.pair("uv_offset");
  out.scale = fields.vector("scale");
  out.offset = fields.vector("offset");
  return out;
}

// One parameter of the model: a number, three, or a texture.
void read_parameter(const Fields& fields, const Value& value, const std::filesystem::path& folder, Loading& loading,
                    Material& out) {
  const std::string path = fields.path() + "/parameters/";
  const auto refuse = [&](const std::string& text) { refuse_at(fields.source(), value.line, path + text); };
  if (value.is_object()) {
    // The row's own value is its default, which says how many channels it has; an unknown one is refused by assign.
    const std::vector<material::Entry> rows = material::entries(out.brdf);
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& one) { return one.row.name == value.key; });
    if (row == rows.end()) refuse(material::assign(out.brdf, value.key, {}));
    const Fields inner(fields.source(), value, kTextureSection, path + json::plain(value.key));
    bind_texture(out, value.key, texture_of(inner, {row->row.channels == 3, false}, folder, loading));
    return;
  }
  std::vector<double> channels;
  const bool is_list = value.is_list();
  for (const Value& item : is_list ? value.items : std::vector<Value>{value}) {
    if (!item.is_number())
      refuse(json::plain(value.key) + " is " + json::kind_text(item) +
             "; expected a number, a list of three, or a texture {\"file\": ...}");
    channels.push_back(item.number);
    if (channels.size() > 3) break;
  }
  // A number serves for the three channels of a color, as everywhere in a scene.
  if (!is_list)
    for (const material::Entry& entry : material::entries(out.brdf))
      if (entry.row.name == value.key && entry.row.channels == 3) channels.resize(3, channels[0]);
  const std::string wrong = material::assign(out.brdf, value.key, channels);
  if (!wrong.empty()) refuse(wrong);
}

brdf::Interval interval_of(const Fields& fields, std::string_view key, double (*scale)(double)) {
  const glm::dvec2 ends = fields.pair(key);
  if (!(ends.x < ends.y))
    fields.refuse(key, " = [" + files::number_text(ends.x) + ", " + files::number_text(ends.y) +
                           "]; expected a smaller number first");
  return {scale(ends.x), scale(ends.y)};
}

Material::BakedResidual residual_of(const Fields& fields, const std::filesystem::path& folder, Loading& loading) {
  Material::BakedResidual out;
  const auto itself = [](double x) { return x; };
  // 1 - cos; what no angle reaches goes on straight, so that ends keep their order.
  const auto versine = [](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return angle < std::numbers::pi ? 1 - std::cos(angle) : 2 + (angle - std::numbers::pi);
  };
  const brdf::RealisFade fade{interval_of(fields, "fade_base_color", itself),
                              interval_of(fields, "fade_roughness", itself),
                              interval_of(fields, "fade_normal_deg", versine)};
  out.strength = static_cast<float>(fields.number("strength"));
  out.jitter = fields.whole("jitter");
  out.bake = loading.bake(folder / fields.text("bake"));
  if (fields.flag("fades") && loading.scene().bakes[out.bake].surface) out.fade = fade;
  return out;
}

}  // namespace

Material material_of(const Fields& fields, const std::string& name, const std::filesystem::path& folder,
                     Loading& loading) {
  Material out;
  out.name = name;
  fields.only_one_of("file", "model");
  if (fields.has("file")) {
    const std::filesystem::path file = folder / fields.text("file");
    out.brdf = material::material_of(loading.bytes(file, material::kLargestFile), file.string()).brdf;
  } else if (!brdf::model_of_name(fields.text("model"), out.brdf)) {
    fields.refuse("model", ": " + material::no_such_model(fields.text("model")));
  }
  if (const Value* parameters = fields.value().find("parameters"))
    for (const Value& value : parameters->items)
      if (value.key != kComment) read_parameter(fields, value, folder, loading, out);

  const auto map = [&](std::string_view key, Purpose purpose) -> std::optional<Texture> {
    const std::optional<Fields> inner = fields.object(key);
    if (!inner) return std::nullopt;
    return texture_of(*inner, purpose, folder, loading);
  };
  const auto normals = [&](std::string_view key) {
    std::optional<Texture> texture = map(key, {true, false});
    if (texture && !fields.object(key)->has("transfer")) texture->transfer = Transfer::kLinear;
    return texture;
  };
  out.normal_map = normals("normal_map");
  out.normal_strength = static_cast<float>(fields.number("normal_strength"));
  out.diffuse_normal_map = normals("diffuse_normal_map");
  out.opacity = map("opacity", {});
  out.opacity_cutoff = static_cast<float>(fields.number("opacity_cutoff"));
  out.emission = fields.vector("emission") / (fields.text("emission_unit") == "cd/m2" ? kLumensPerWatt : 1.0);
  out.emission_map = map("emission_map", {true, true});
  if (out.emission_map && !fields.has("emission"))
    fields.refuse("emission_map", " multiplies \"emission\", which is not given and therefore 0");
  out.two_sided = fields.flag("two_sided");
  if (const std::optional<Fields> inner = fields.object("realis")) out.residual = residual_of(*inner, folder, loading);
  return out;
}

}  // namespace likeness::scene
