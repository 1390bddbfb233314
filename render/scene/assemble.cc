#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/files/files.h"
#include "render/scene/format.h"
#include "render/scene/mend.h"
#include "render/scene/mesh_file.h"
#include "render/scene/read_entries.h"
#include "render/scene/read_scene.h"
#include "render/scene/trim.h"

namespace likeness::scene {
namespace {

using files::in_quotes;

bool has_texture(const Material& material) {
  return !material.bindings.empty() || material.normal_map || material.diffuse_normal_map || material.opacity ||
         material.emission_map;
}

// A mesh of the scene file, read: where its parts are in the scene.
struct Placed {
  struct Part {
    std::string name, material_name;
    Index mesh = kNone, material = kNone;  // kNone: the file gives none
    glm::dmat4 world_from_object{1};
  };
  std::vector<Part> parts;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
};

// Moves what a mesh file holds into the scene, mended.
Placed place(MeshFile&& file, Normals normals, bool is_flipped, const std::string& where, Loading& loading) {
  Scene& scene = loading.scene();
  Placed out;
  const auto first_mesh = static_cast<Index>(scene.meshes.size());
  const auto first_material = static_cast<Index>(scene.materials.size());
  for (Mesh& mesh : file.meshes) {
    if (is_flipped) flip_v(mesh);
    mend(mesh, normals, where, loading);
    mesh.name = mesh.name.empty() ? where : where + " (" + mesh.name + ")";
    scene.meshes.push_back(std::move(mesh));
  }
  for (Material& material : file.materials) scene.materials.push_back(std::move(material));
  std::map<Index, Index> plain;  // materials to their copies without textures
  for (const MeshFile::Part& part : file.parts) {
    Placed::Part placed{part.name, "", first_mesh + static_cast<Index>(part.mesh), kNone, part.world_from_object};
    if (scene.meshes[placed.mesh].triangles.empty() && !scene.meshes[placed.mesh].is_sphere) {
      loading.repair("parts without a triangle left out", where);
      continue;
    }
    if (part.material != kNone) {
      placed.material = first_material + part.material;
      placed.material_name = scene.materials[placed.material].name;
      if (scene.meshes[placed.mesh].uvs.empty() && has_texture(scene.materials[placed.material])) {
        loading.repair("parts without texture coordinates: their textures left out", where);
        const auto [copy, fresh] = plain.try_emplace(placed.material, static_cast<Index>(scene.materials.size()));
        if (fresh) {
          Material bare = scene.materials[placed.material];
          bare.bindings.clear();
          bare.normal_map = bare.diffuse_normal_map = bare.opacity = bare.emission_map = std::nullopt;
          scene.materials.push_back(std::move(bare));
        }
        placed.material = copy->second;
      }
    }
    out.parts.push_back(std::move(placed));
  }
  out.cameras = std::move(file.cameras);
  out.lights = std::move(file.lights);
  return out;
}

// A part's own nodes may flatten it, or put it farther out than numbers go.
bool is_sound(const glm::mat4& m) {
  const glm::dmat3 turn(m);
  const double lengths = glm::length(turn[0]) * glm::length(turn[1]) * glm::length(turn[2]);
  const bool is_near = glm::length(glm::dvec3(m[3])) < static_cast<double>(kFarthest) && lengths < 1e27;
  return is_near && lengths > 0 && std::abs(glm::determinant(turn)) > 1e-9 * lengths;
}

// Turned, moved and scaled alike along its axes, as far as a tracer of spheres minds: it allows 1e-5 of a float.
bool keeps_spheres_round(const glm::dmat3& m) {
  const double a = glm::dot(m[0], m[0]), off = 5e-6 * a;
  return std::abs(a - glm::dot(m[1], m[1])) < off && std::abs(a - glm::dot(m[2], m[2])) < off &&
         std::abs(glm::dot(m[0], m[1])) < off && std::abs(glm::dot(m[0], m[2])) < off &&
         std::abs(glm::dot(m[1], m[2])) < off;
}

void add(Instance&& instance, Loading& loading) {
  if (is_sound(instance.world_from_object)) loading.scene().instances.push_back(std::move(instance));
  else
    loading.repair("parts that their nodes make flat, or move beyond 1e9 m, left out",
                   loading.scene().meshes[instance.mesh].name);
}

Index plain_material(Loading& loading, Index& at) {
  if (at == kNone) {
    loading.scene().materials.push_back({});
    loading.scene().materials.back().name = "default";
    at = static_cast<Index>(loading.scene().materials.size() - 1);
  }
  return at;
}

void make_missing_tangents(Loading& loading) {
  Scene& scene = loading.scene();
  for (const Instance& instance : scene.instances) {
    const Material& material = scene.materials[instance.material];
    Mesh& mesh = scene.meshes[instance.mesh];
    if ((material.normal_map || material.diffuse_normal_map) && mesh.tangents.empty() && !mesh.is_sphere)
      make_tangents(mesh, mesh.name, loading);
  }
}

bool has_light(const Scene& scene) {
  if (scene.environment || !scene.lights.empty()) return true;
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    return scene.materials[instance.material].emission != glm::vec3(0);
  });
}

// From the front, a little from above and from the right, so far away that a sphere around everything fits.
Camera camera_of_all(const Bounds& all) {
  constexpr double kFov = 40 * std::numbers::pi / 180;
  Camera out;
  out.name = "all";
  out.focal_x = out.focal_y = 0.5 * out.height / std::tan(kFov / 2);
  const glm::dvec3 low = all.is_empty() ? glm::dvec3(-1) : glm::dvec3(all.low),
                   high = all.is_empty() ? glm::dvec3(1) : glm::dvec3(all.high);
  const double radius = std::max(0.5 * glm::length(high - low), 1e-6), distance = 1.02 * radius / std::sin(kFov / 2);
  const glm::dvec3 ahead = glm::normalize(glm::dvec3(-0.4, -0.3, -1));
  out.world_from_camera = glm::mat4(look_along(0.5 * (low + high) - distance * ahead, ahead, glm::dvec3(0, 1, 0)));
  out.focus_distance = static_cast<float>(distance);
  return out;
}

void complete(Loading& loading, const std::string& source) {
  Scene& scene = loading.scene();
  trim(scene);
  make_missing_tangents(loading);
  if (scene.instances.empty()) loading.repair("nothing stands in the scene", source);
  if (scene.cameras.empty()) {
    scene.cameras.push_back(camera_of_all(bounds(scene)));
    loading.repair("no camera: one made that sees everything", source);
  }
  if (!has_light(scene)) loading.repair("no light: the picture will be black", source);
}

// The scene file; one object a file.
class Assembly {
 public:
  Assembly(const Fields& fields, const std::filesystem::path& folder, Loading& loading)
      : fields_(fields), folder_(folder), loading_(loading), scene_(loading.scene()) {
    for (Fields& mesh : fields.list("meshes")) meshes_.emplace(mesh.value().key, std::move(mesh));
    for (Fields& material : fields.list("materials")) materials_.emplace(material.value().key, std::move(material));
  }

  void read() {
    scene_.name = fields_.text("name");
    for (const Fields& camera : fields_.list("cameras")) scene_.cameras.push_back(camera_of(camera));
    refuse_twin_cameras();
    for (const Fields& light : fields_.list("lights")) scene_.lights.push_back(light_of(light, folder_, loading_));
    if (const auto environment = fields_.object("environment"))
      scene_.environment = environment_of(*environment, folder_, loading_);
    if (const auto view = fields_.object("view")) scene_.view = view_of(*view, folder_);
    for (const Fields& instance : fields_.list("instances")) read_instance(instance);
  }

 private:
  void refuse_twin_cameras() const {
    std::map<std::string, std::size_t> first;
    for (std::size_t i = 0; i < scene_.cameras.size(); ++i) {
      const std::string& name = scene_.cameras[i].name;
      if (!name.empty() && !first.emplace(name, i).second)
        fields_.list("cameras")[i].refuse(
            "name", " = " + in_quotes(name) + " is the name of /cameras/" + std::to_string(first[name]) + " too");
    }
  }

  template <class Map>
  static std::vector<std::string_view> names_of(const Map& map) {
    std::vector<std::string_view> out;
    for (const auto& [name, entry] : map) out.push_back(name);
    return out;
  }

  const Placed& mesh(const Fields& user) {
    const std::string name = user.text("mesh");
    if (const auto done = placed_.find(name); done != placed_.end()) return done->second;
    const auto found = meshes_.find(name);
    if (found == meshes_.end())
      user.refuse("mesh", " = " + in_quotes(name) + " is not in /meshes" + near_text(name, names_of(meshes_)));
    return placed_.emplace(name, read_mesh(found->second, name)).first->second;
  }

  Placed read_mesh(const Fields& mesh, const std::string& name) {
    mesh.only_one_of("file", "shape");
    if (!mesh.has("file") && !mesh.has("shape"))
      mesh.refuse(" has neither \"file\" nor \"shape\"; expected one of them");
    MeshFile file;
    std::string where = mesh.path().substr(1);
    if (mesh.has("file")) {
      for (const char* key : {"size", "segments"}) mesh.only_one_of("file", key);
      const std::filesystem::path path = folder_ / mesh.text("file");
      where = path.string();
      file = read_mesh_file(path, mesh.text("part"), loading_);
    } else {
      mesh.only_one_of("shape", "part");
      file.meshes.push_back(shape_mesh(mesh.text("shape"), mesh.vector("size"), mesh.whole("segments")));
      file.parts.push_back({name, 0, kNone, glm::dmat4(1)});
    }
    const std::string normals = mesh.text("normals");
    return place(std::move(file),
                 normals == "smooth" ? Normals::kSmooth
                 : normals == "flat" ? Normals::kFlat
                                     : Normals::kFile,
                 mesh.flag("flip_v"), where, loading_);
  }

  // Of that name; `key` and `user` are for the message.
  Index material(const std::string& name, const Fields& user, std::size_t line, const std::string& path) {
    if (const auto done = made_.find(name); done != made_.end()) return done->second;
    const auto found = materials_.find(name);
    if (found == materials_.end())
      refuse_at(user.source(), line,
                path + " = " + in_quotes(name) + " is not in /materials" + near_text(name, names_of(materials_)));
    scene_.materials.push_back(material_of(found->second, name, folder_, loading_));
    return made_[name] = static_cast<Index>(scene_.materials.size() - 1);
  }

  void read_instance(const Fields& instance) {
    const glm::dmat4 place = place_of(instance);
    const Placed& placed = mesh(instance);
    Index whole = kNone;
    if (instance.has("material"))
      whole = material(instance.text("material"), instance, instance.value().find("material")->line,
                       instance.path() + "/material");
    const std::map<std::string, Index> exchanged = exchanges(instance, placed);
    for (const Placed::Part& part : placed.parts) {
      Instance out;
      out.name = instance.text("name").empty() ? instance.text("mesh") : instance.text("name");
      if (placed.parts.size() > 1 && !part.name.empty()) out.name += "/" + part.name;
      out.mesh = part.mesh;
      const auto own = exchanged.find(part.material_name);
      out.material = own != exchanged.end() ? own->second : whole != kNone ? whole : part.material;
      if (out.material == kNone) out.material = plain_material(loading_, plain_);
      const Mesh& mesh = scene_.meshes[out.mesh];
      if (out.material != part.material && mesh.uvs.empty() && !mesh.is_sphere &&
          has_texture(scene_.materials[out.material]))
        instance.refuse("mesh", " = " + in_quotes(instance.text("mesh")) +
                                    " has no texture coordinates, but material " +
                                    in_quotes(scene_.materials[out.material].name) + " has textures");
      if (scene_.materials[out.material].residual && mesh.uvs.empty() && !mesh.is_sphere)
        instance.refuse("mesh", " = " + in_quotes(instance.text("mesh")) +
                                    " has no texture coordinates, but material " +
                                    in_quotes(scene_.materials[out.material].name) +
                                    " has a bake (\"realis\"), whose texels are placed by them");
      out.world_from_object = glm::mat4(place * part.world_from_object);
      if (mesh.is_sphere && !keeps_spheres_round(glm::dmat3(out.world_from_object)))
        instance.refuse("mesh", " = " + in_quotes(instance.text("mesh")) +
                                    " is a sphere that is stretched or sheared; use the shape \"faceted_sphere\"");
      if (scene_.instances.size() == kMostParts)
        instance.refuse(": with it more than " + std::to_string(kMostParts) + " parts stand in the scene");
      add(std::move(out), loading_);
    }
  }

  std::map<std::string, Index> exchanges(const Fields& instance, const Placed& placed) {
    std::map<std::string, Index> out;
    const json::Value* names = instance.value().find("materials");
    if (!names) return out;
    for (const json::Value& name : names->items) {
      if (name.key == kComment) continue;
      const std::string path = instance.path() + "/materials/" + json::plain(name.key);
      if (!name.is_text())
        refuse_at(instance.source(), name.line,
                  path + " is " + json::kind_text(name) + "; expected a key in /materials");
      std::vector<std::string_view> there;
      for (const Placed::Part& part : placed.parts)
        if (part.material != kNone && std::find(there.begin(), there.end(), part.material_name) == there.end())
          there.push_back(part.material_name);
      if (std::find(there.begin(), there.end(), name.key) == there.end())
        refuse_at(instance.source(), name.line,
                  path + " is no material of the mesh's file" + near_text(name.key, there));
      out[name.key] = material(name.text, instance, name.line, path);
    }
    return out;
  }

  const Fields& fields_;
  const std::filesystem::path& folder_;
  Loading& loading_;
  Scene& scene_;
  std::map<std::string, Fields> meshes_, materials_;
  std::map<std::string, Placed> placed_;
  std::map<std::string, Index> made_;
  Index plain_ = kNone;
};

}  // namespace

Bounds bounds(const Scene& scene) {
  std::vector<Bounds> local(scene.meshes.size());
  for (std::size_t i = 0; i < local.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    if (mesh.is_sphere) local[i] = {glm::vec3(-1), glm::vec3(1)};
    for (const glm::vec3& p : mesh.positions) local[i] = {glm::min(local[i].low, p), glm::max(local[i].high, p)};
  }
  Bounds out;
  for (const Instance& instance : scene.instances) {
    const Bounds& box = local[instance.mesh];
    if (box.is_empty()) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec4 p(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                        corner & 4 ? box.high.z : box.low.z, 1);
      const glm::vec3 world(instance.world_from_object * p);
      out = {glm::min(out.low, world), glm::max(out.high, world)};
    }
  }
  return out;
}

Scene scene_of(std::string_view text, const std::string& source, const std::filesystem::path& folder,
               const Access& access) {
  const json::Value value = json::parse(text, source);
  if (value.is_object() && !value.find("format"))
    refuse_at(source, 1,
              "/format is missing: a scene of Likeness begins {\"format\": \"likeness scene\", \"version\": 1, ...");
  const Fields fields(source, value, kSceneSection, "");
  if (fields.text("format") != kFormatName)
    fields.refuse("format", " = " + in_quotes(fields.text("format")) + "; expected " + in_quotes(kFormatName));
  Scene scene;
  Loading loading(scene, access);
  Assembly(fields, folder, loading).read();
  complete(loading, source);
  return scene;
}

Scene scene_of_mesh(const std::filesystem::path& file, const Access& access) {
  Scene scene;
  Loading loading(scene, access);
  scene.name = file.stem().string();
  Placed placed = place(read_mesh_file(file, "", loading), Normals::kFile, false, file.string(), loading);
  scene.cameras = std::move(placed.cameras);
  scene.lights = std::move(placed.lights);
  Index plain = kNone;
  for (const Placed::Part& part : placed.parts)
    add({part.name, part.mesh, part.material == kNone ? plain_material(loading, plain) : part.material,
         glm::mat4(part.world_from_object)},
        loading);
  if (!has_light(scene)) {
    scene.environment = Environment{};
    loading.repair("no light: an environment of radiance 1 added", file.string());
  }
  complete(loading, file.string());
  return scene;
}

}  // namespace likeness::scene
