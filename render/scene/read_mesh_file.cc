#include <algorithm>
#include <cctype>

#include "render/files/files.h"
#include "render/scene/mend.h"
#include "render/scene/mesh_file.h"

namespace likeness::scene {
namespace {

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  return ending == ".glb" || ending == ".gltf" || ending == ".obj" || ending == ".ply";
}

MeshFile read_mesh_file(const std::filesystem::path& file, const std::string& part, Loading& loading) {
  if (!is_mesh_file(file))
    throw files::InputError(file.string() + ": its name ends in " + files::in_quotes(file.extension().string()) +
                            "; expected a mesh: .glb, .gltf, .obj or .ply");
  const std::string ending = ending_of(file);
  const std::string bytes = loading.bytes(file, kMostMeshFileBytes);
  if (ending == ".glb" || ending == ".gltf") return gltf_of(bytes, file, part, loading);
  MeshFile out = ending == ".obj" ? obj_of(bytes, file, part, loading) : ply_of(bytes, file, part, loading);
  for (Mesh& mesh : out.meshes) flip_v(mesh);
  return out;
}

void bind_texture(Material& material, std::string_view parameter, const Texture& texture) {
  std::size_t index = 0, row = 0;
  std::visit(
      [&](const auto& model) {
        for (const brdf::Parameter& one : model.kParameters) {
          if (one.name == parameter) index = row;
          ++row;
        }
      },
      material.brdf);
  for (Material::Binding& binding : material.bindings)
    if (binding.parameter == index) {
      binding.texture = texture;
      return;
    }
  material.bindings.push_back({index, texture});
}

}  // namespace likeness::scene
