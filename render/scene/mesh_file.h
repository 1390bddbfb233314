#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "render/scene/loading.h"
#include "render/scene/scene.h"

namespace likeness::scene {

// What a mesh file holds, as it holds it: positions, indices and normals may be anything (mend.h puts them right), but
// every index is inside its mesh. Materials index the scene's images.
struct MeshFile {
  struct Part {
    std::string name;
    std::size_t mesh = 0;
    Index material = kNone;  // in `materials`
    glm::dmat4 world_from_object{1};
  };
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Part> parts;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
};

// By the ending of its name: .glb, .gltf, .obj, .ply. `part`: see docs/scene.md; empty: all. OBJ's V is turned to run
// downwards. Throws files::InputError, one line that begins with the file.
MeshFile read_mesh_file(const std::filesystem::path& file, const std::string& part, Loading& loading);
bool is_mesh_file(const std::filesystem::path& file);

// The same from bytes; `file` is for messages and for the files that it names.
MeshFile gltf_of(std::string_view bytes, const std::filesystem::path& file, const std::string& part, Loading& loading);
MeshFile obj_of(std::string_view bytes, const std::filesystem::path& file, const std::string& part, Loading& loading);
MeshFile ply_of(std::string_view bytes, const std::filesystem::path& file, const std::string& part, Loading& loading);

// The materials of an OBJ's library, appended to `out`.
void read_mtl(std::string_view bytes, const std::filesystem::path& file, Loading& loading, std::vector<Material>& out);

// Meshes that are made here (docs/scene.md, `shape`).
Mesh shape_mesh(const std::string& shape, const glm::dvec3& size, int segments);

// Gives a row of the material's model, by name, to a texture, instead of one that it may have had.
void bind_texture(Material& material, std::string_view parameter, const Texture& texture);

}  // namespace likeness::scene
