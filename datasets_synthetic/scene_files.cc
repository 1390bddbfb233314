#include "datasets_synthetic/scene_files.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

#include "render/files/files.h"
#include "render/image/layers.h"

namespace likeness::datasets_synthetic {
namespace {

constexpr std::size_t kLineLength = 110;

std::string on_one_line(const SceneJson& value) {
  if (!value.is_structured() || value.empty()) return value.dump();
  std::string out = value.is_array() ? "[" : "{", separator;
  for (const auto& [key, item] : value.items()) {
    out += separator;
    if (value.is_object()) out += SceneJson(key).dump() + ": ";
    out += on_one_line(item);
    separator = ", ";
  }
  return out + (value.is_array() ? "]" : "}");
}

std::string indented(const SceneJson& value, std::size_t depth) {
  std::string line = on_one_line(value);
  if (!value.is_structured() || (depth > 0 && line.size() + 2 * depth <= kLineLength)) return line;
  std::string out = value.is_array() ? "[\n" : "{\n", separator;
  const std::string margin(2 * depth, ' ');
  for (const auto& [key, item] : value.items()) {
    out += separator + margin + "  ";
    if (value.is_object()) out += SceneJson(key).dump() + ": ";
    out += indented(item, depth + 1);
    separator = ",\n";
  }
  return out + "\n" + margin + (value.is_array() ? "]" : "}");
}

void append(std::string& out, float value) {
  static_assert(std::endian::native == std::endian::little);
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}
void append(std::string& out, std::uint32_t value) { out.append(reinterpret_cast<const char*>(&value), sizeof value); }

// PLY has v upwards.
std::string ply_of(const scene::Mesh& mesh) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
                    "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!mesh.normals.empty()) out += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.uvs.empty()) out += "property float u\nproperty float v\n";
  out += "element face " + std::to_string(mesh.triangles.size()) +
         "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (int k = 0; k < 3; ++k) append(out, mesh.positions[i][k]);
    if (!mesh.normals.empty())
      for (int k = 0; k < 3; ++k) append(out, mesh.normals[i][k]);
    if (!mesh.uvs.empty()) append(out, mesh.uvs[i].x), append(out, 1 - mesh.uvs[i].y);
  }
  for (const auto& triangle : mesh.triangles) {
    out += '\3';
    for (const scene::Index corner : triangle) append(out, corner);
  }
  return out;
}

scene::Mesh without_idle_vertices(scene::Mesh mesh) {
  std::vector<scene::Index> place(mesh.positions.size(), scene::kNone);
  scene::Mesh out = mesh;
  out.positions.clear();
  out.normals.clear();
  out.uvs.clear();
  for (auto& triangle : out.triangles)
    for (scene::Index& corner : triangle) {
      const scene::Index from = corner;
      if (place[from] == scene::kNone) {
        place[from] = static_cast<scene::Index>(out.positions.size());
        out.positions.push_back(mesh.positions[from]);
        if (!mesh.normals.empty()) out.normals.push_back(mesh.normals[from]);
        if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[from]);
      }
      corner = place[from];
    }
  return out;
}

}  // namespace

std::string pretty(const SceneJson& value) { return indented(value, 0) + "\n"; }

SceneFiles::SceneFiles(std::filesystem::path folder, const std::string& kind) : folder_(std::move(folder)) {
  document_ = {{"format", "likeness scene"},
               {"version", 1},
               {"comment", std::string(kMadeBy) + " " + kind},
               {"name", kind},
               {"cameras", SceneJson::array()},
               {"meshes", SceneJson::object()},
               {"materials", SceneJson::object()},
               {"instances", SceneJson::array()},
               {"lights", SceneJson::array()}};
}

void SceneFiles::add_mesh(const std::string& name, scene::Mesh mesh) {
  const std::string file = "meshes/" + name + ".ply";
  files::write_whole(folder_ / file, ply_of(without_idle_vertices(std::move(mesh))));
  document_["meshes"][name] = {{"file", file}};
  ++meshes_;
}

void SceneFiles::add_shape(const std::string& name, const SceneJson& shape) {
  document_["meshes"][name] = shape;
  ++meshes_;
}

SceneJson SceneFiles::add_texture(const std::string& name, int width, int height, int channels, const Texel& texel) {
  image::Layer layer;
  layer.channels = channels == 1 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
  layer.storage = image::Storage::kHalf;
  layer.data.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * layer.channels.size());
  float* at = layer.data.data();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, at += layer.channels.size()) texel((x + 0.5) / width, (y + 0.5) / height, at);
  const std::string file = "textures/" + name + ".exr";
  image::write_layers(folder_ / file, {width, height, {std::move(layer)}, ""});
  ++textures_;
  return {{"file", file}};
}

void SceneFiles::add_material(const std::string& name, const SceneJson& material) {
  document_["materials"][name] = material;
}

void SceneFiles::add_instance(const std::string& mesh, const std::string& material, const SceneJson& placement) {
  SceneJson instance{{"mesh", mesh}, {"material", material}};
  for (const auto& [key, value] : placement.items()) instance[key] = value;
  document_["instances"].push_back(std::move(instance));
}

void SceneFiles::write(const std::string& file) {
  files::write_whole(folder_ / file, pretty(document_));
  scenes_.push_back(folder_ / file);
}

}  // namespace likeness::datasets_synthetic
