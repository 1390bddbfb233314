#include "render/scene/gltf_materials.h"

#include <algorithm>
#include <cmath>

#include "render/files/files.h"
#include "render/scene/mesh_file.h"

namespace likeness::scene {
namespace {

using Callisto = brdf::Callisto<double>;
using Node = GltfDocument::Node;

constexpr double kDielectricScale = 0.08;  // Callisto's `specular` is f0 over it

class MaterialReader {
 public:
  MaterialReader(const GltfDocument& document, const Node& material, Loading& loading)
      : document_(document), node_(material), loading_(loading) {}

  Material material() {
    Material out;
    out.name = document_.text(node_, "name");
    out.two_sided = document_.flag(node_, "doubleSided");
    if (document_.has(document_.member(node_, "extensions"), "KHR_materials_unlit"))
      loading_.repair("unlit materials taken as lit", where());
    read_reflection(out);
    read_normals(out);
    read_emission(out);
    return out;
  }

 private:
  std::string where() const { return document_.source() + " (" + node_.path.substr(1) + ")"; }

  double clamped(double x, double low, double high) {
    if (x >= low && x <= high) return x;
    loading_.repair("factors of materials brought into their range", where());
    return x > high ? high : low;  // NaN is not in JSON
  }

  void read_reflection(Material& out) {
    auto& callisto = std::get<Callisto>(out.brdf);
    const Node pbr = document_.member(node_, "pbrMetallicRoughness");
    const auto color = document_.numbers(pbr, "baseColorFactor", {1, 1, 1, 1});
    const double metallic = clamped(document_.number(pbr, "metallicFactor", 1), 0, 1);
    const double roughness = clamped(document_.number(pbr, "roughnessFactor", 1), 0, 1);
    const double r = clamped(color[0], 0, 1), g = clamped(color[1], 0, 1), b = clamped(color[2], 0, 1);
    callisto.base_color = brdf::Rgb<double>{r, g, b};
    callisto.metallic = metallic;
    callisto.roughness = roughness;
    callisto.specular = specular();

    const std::string mode = document_.text(node_, "alphaMode");
    const bool is_cut = mode == "MASK" || mode == "BLEND";
    if (mode == "BLEND") loading_.repair("blended alpha taken as a cut-out at one half", where());
    out.opacity_cutoff =
        static_cast<float>(mode == "MASK" ? clamped(document_.number(node_, "alphaCutoff", 0.5), 0, 1) : 0.5);
    if (const Node base = document_.member(pbr, "baseColorTexture")) {
      Texture t = texture(base, Transfer::kSrgb, false);
      t.scale = glm::vec3(r, g, b);
      bind_texture(out, "base_color", t);
      if (is_cut && loading_.scene().images[t.image].texels.channels % 2 == 0) {
        t.transfer = Transfer::kLinear;  // alpha is, whatever the color
        t.channel = loading_.scene().images[t.image].texels.channels - 1;
        t.scale = glm::vec3(static_cast<float>(clamped(color[3], 0, 1)));
        out.opacity = t;
      }
    }
    if (const Node map = document_.member(pbr, "metallicRoughnessTexture")) {
      Texture t = texture(map, Transfer::kLinear, false);
      t.channel = 1;
      t.scale = glm::vec3(static_cast<float>(roughness));
      bind_texture(out, "roughness", t);
      t.channel = 2;
      t.scale = glm::vec3(static_cast<float>(metallic));
      bind_texture(out, "metallic", t);
    }
  }

  // Of KHR_materials_ior and KHR_materials_specular: f0 = ((n - 1) / (n + 1))^2 times the factor.
  double specular() {
    const Node extensions = document_.member(node_, "extensions");
    const double ior = document_.number(document_.member(extensions, "KHR_materials_ior"), "ior", 1.5);
    const double factor = document_.number(document_.member(extensions, "KHR_materials_specular"), "specularFactor", 1);
    const double root = ior == 0 ? 1 : (ior - 1) / (ior + 1);  // 0 stands for the largest
    return clamped(factor * root * root / kDielectricScale, 0, 1);
  }

  void read_normals(Material& out) {
    const Node map = document_.member(node_, "normalTexture");
    if (!map) return;
    out.normal_map = texture(map, Transfer::kLinear, false);
    out.normal_strength = static_cast<float>(clamped(document_.number(map, "scale", 1), -100, 100));
  }

  void read_emission(Material& out) {
    const auto factor = document_.numbers(node_, "emissiveFactor", {0, 0, 0});
    const Node extensions = document_.member(node_, "extensions");
    const double strength =
        document_.number(document_.member(extensions, "KHR_materials_emissive_strength"), "emissiveStrength", 1);
    for (int c = 0; c < 3; ++c)
      out.emission[c] =
          static_cast<float>(clamped(factor[static_cast<std::size_t>(c)] * strength, 0, 1e12) / kLumensPerWatt);
    const Node map = document_.member(node_, "emissiveTexture");
    if (map && out.emission != glm::vec3(0)) out.emission_map = texture(map, Transfer::kSrgb, true);
  }

  Texture texture(const Node& info, Transfer transfer, bool is_light) {
    Texture out;
    out.transfer = transfer;
    const Node texture = document_.named(info, "index", "textures");
    if (!document_.has(texture, "source"))
      document_.refuse(texture, "/source is missing: its picture is of an extension that is not read");
    out.image = image(document_.named(texture, "source", "images"), is_light);
    // With fewer channels than are asked for, grey serves for all.
    if (document_.has(texture, "sampler")) {
      const Node sampler = document_.named(texture, "sampler", "samplers");
      constexpr std::size_t kClamp = 33071, kRepeat = 10497;
      const std::size_t s = document_.whole(sampler, "wrapS", kRepeat), t = document_.whole(sampler, "wrapT", kRepeat);
      if (s == kClamp && t == kClamp) out.wrap = Wrap::kClamp;
      else if (s != kRepeat || t != kRepeat) loading_.repair("mirrored or mixed wrapping taken as repeated", where());
    }
    std::size_t set = document_.whole(info, "texCoord", 0);
    if (const Node transform = document_.member(document_.member(info, "extensions"), "KHR_texture_transform")) {
      const auto scale = document_.numbers(transform, "scale", {1, 1});
      const auto offset = document_.numbers(transform, "offset", {0, 0});
      out.uv_scale = glm::vec2(clamped(scale[0], -1e6, 1e6), clamped(scale[1], -1e6, 1e6));
      out.uv_offset = glm::vec2(clamped(offset[0], -1e6, 1e6), clamped(offset[1], -1e6, 1e6));
      set = document_.whole(transform, "texCoord", set);
      if (document_.number(transform, "rotation", 0) != 0)
        loading_.repair("turned texture coordinates taken as not turned", where());
    }
    if (set != 0) loading_.repair("second texture coordinates taken as the first", where());
    return out;
  }

  Index image(const Node& node, bool is_light) {
    if (document_.has(node, "bufferView"))
      return loading_.image(document_.buffer_view(document_.whole(node, "bufferView", 0), node),
                            document_.source() + " (" + node.path.substr(1) + ")", is_light);
    const std::string uri = document_.text(node, "uri");
    if (uri.empty()) document_.refuse(node, " has neither uri nor bufferView");
    if (GltfDocument::is_data_uri(uri))
      return loading_.image(document_.data_of_uri(uri, node), document_.source() + " (" + node.path.substr(1) + ")",
                            is_light);
    return loading_.image(document_.file_of_uri(uri, node), is_light);
  }

  const GltfDocument& document_;
  const Node& node_;
  Loading& loading_;
};

}  // namespace

Material gltf_material(const GltfDocument& document, const GltfDocument::Node& material, Loading& loading) {
  return MaterialReader(document, material, loading).material();
}

}  // namespace likeness::scene
