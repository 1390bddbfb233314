#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "render/files/files.h"
#include "render/scene/format.h"
#include "render/scene/gltf_document.h"
#include "render/scene/gltf_materials.h"
#include "render/scene/mesh_file.h"

// glTF 2.0: the nodes of its default scene, each primitive of their meshes as a part, their cameras and the lights of
// KHR_lights_punctual. Skins, morph targets, animations and vertex colors are read over.
namespace likeness::scene {
namespace {

using files::in_quotes;
using Node = GltfDocument::Node;

class GltfReader {
 public:
  GltfReader(const GltfDocument& document, const std::string& part, Loading& loading)
      : document_(document), part_(part), loading_(loading) {}

  MeshFile mesh_file() {
    materials_.resize(document_.count("materials"), kNone);
    primitives_.resize(document_.count("meshes"));
    visit_nodes();
    if (!part_.empty() && !has_part_) {
      std::vector<std::string> names;
      for (std::size_t i = 0; i < document_.count("nodes") && i < 1000; ++i)
        if (std::string name = document_.text(document_.entry("nodes", i, document_.root()), "name"); !name.empty())
          names.push_back(std::move(name));
      throw files::InputError(document_.source() + ": has no node " + in_quotes(part_) + " in its scene" +
                              near_text(part_, {names.begin(), names.end()}));
    }
    if (out_.parts.empty()) throw files::InputError(document_.source() + ": shows no triangles; expected a mesh");
    return std::move(out_);
  }

 private:
  struct Open {
    std::size_t node;
    glm::dmat4 world;
    bool is_taken;
    Node user;
  };

  // Depth first with a stack of its own. A node may be reached once: glTF nodes are trees, and what is not, a node below
  // itself first of all, would have no end.
  void visit_nodes() {
    const std::size_t count = document_.count("nodes");
    std::vector<bool> seen(count, false);
    std::vector<Open> open;
    for (const auto& [node, user] : roots()) open.push_back({node, glm::dmat4(1), part_.empty(), user});
    std::reverse(open.begin(), open.end());
    while (!open.empty()) {
      const Open next = open.back();
      open.pop_back();
      const Node node = document_.entry("nodes", next.node, next.user);
      const std::string name = document_.text(node, "name");
      if (seen[next.node])
        document_.refuse(next.user, " reaches node " + std::to_string(next.node) +
                                        (name.empty() ? "" : " " + in_quotes(name)) +
                                        " a second time; nodes must form a tree");
      seen[next.node] = true;
      const glm::dmat4 world = next.world * local(node);
      for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
          if (!(std::abs(world[c][r]) <= static_cast<double>(kFarthest)))
            document_.refuse(node, ": its place in the world is no number below 1e9");
      const bool is_part = !part_.empty() && name == part_;
      has_part_ |= is_part;
      const bool is_taken = next.is_taken || is_part;
      if (is_taken) read_node(node, name, world);
      const std::size_t first = open.size();
      for (const Node& child : document_.list(node, "children"))
        open.push_back({index_of(child), world, is_taken, child});
      std::reverse(open.begin() + static_cast<std::ptrdiff_t>(first), open.end());
    }
  }

  std::size_t index_of(const Node& number) const {
    const double value = number.value->number;
    if (!number.value->is_number() || !(value >= 0 && value < 4e9) || value != std::floor(value))
      document_.refuse(number, " is " + json::kind_text(*number.value) + "; expected the index of a node");
    return static_cast<std::size_t>(value);
  }

  // The nodes of the default scene; in a file without scenes, all that are no one's child.
  std::vector<std::pair<std::size_t, Node>> roots() const {
    std::vector<std::pair<std::size_t, Node>> out;
    if (document_.count("scenes") > 0) {
      const Node scene = document_.named(document_.root(), "scene", "scenes");
      for (const Node& node : document_.list(scene, "nodes")) out.emplace_back(index_of(node), node);
      return out;
    }
    const std::vector<Node> nodes = document_.list(document_.root(), "nodes");
    std::vector<bool> is_child(nodes.size(), false);
    for (const Node& node : nodes)
      for (const Node& child : document_.list(node, "children"))
        if (const std::size_t index = index_of(child); index < is_child.size()) is_child[index] = true;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (!is_child[i]) out.emplace_back(i, nodes[i]);
    return out;
  }

  glm::dmat4 local(const Node& node) const {
    glm::dmat4 out(1);
    if (document_.has(node, "matrix")) {
      const auto m = document_.numbers(node, "matrix", std::vector<double>(16));
      for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) out[c][r] = m[static_cast<std::size_t>(4 * c + r)];
      return out;
    }
    const auto t = document_.numbers(node, "translation", {0, 0, 0}), s = document_.numbers(node, "scale", {1, 1, 1}),
               q = document_.numbers(node, "rotation", {0, 0, 0, 1});
    glm::dquat turn(q[3], q[0], q[1], q[2]);
    const double length = std::sqrt(glm::dot(turn, turn));
    turn = length > 1e-12 ? turn / length : glm::dquat(1, 0, 0, 0);
    out = glm::translate(out, glm::dvec3(t[0], t[1], t[2])) * glm::mat4_cast(turn);
    return glm::scale(out, glm::dvec3(s[0], s[1], s[2]));
  }

  void read_node(const Node& node, const std::string& name, const glm::dmat4& world) {
    if (document_.has(node, "mesh")) {
      const std::size_t mesh = document_.whole(node, "mesh", 0);
      const Node mesh_node = document_.named(node, "mesh", "meshes");
      if (document_.has(node, "skin"))
        loading_.repair("skins left out: meshes are as they are bound", document_.source());
      if (!primitives_[mesh]) read_mesh(mesh_node, mesh);
      for (const Primitive& primitive : *primitives_[mesh]) {
        if (out_.parts.size() == kMostParts)
          document_.refuse(node, ": with it the file has more than " + std::to_string(kMostParts) + " parts");
        out_.parts.push_back(
            {name.empty() ? document_.text(mesh_node, "name") : name, primitive.mesh, primitive.material, world});
      }
    }
    if (document_.has(node, "camera")) read_camera(document_.named(node, "camera", "cameras"), name, world);
    if (const Node light = document_.member(document_.member(node, "extensions"), "KHR_lights_punctual"))
      read_light(light, name, world);
  }

  struct Primitive {
    std::size_t mesh;
    Index material;
  };

  void read_mesh(const Node& node, std::size_t index) {
    std::vector<Primitive>& out = primitives_[index].emplace();
    for (const Node& primitive : document_.list(node, "primitives")) {
      const std::size_t mode = document_.whole(primitive, "mode", 4);
      if (mode < 4 || mode > 6) {
        loading_.repair("points and lines left out", document_.source());
        continue;
      }
      if (document_.has(primitive, "targets")) loading_.repair("morph targets left out", document_.source());
      const Node attributes = document_.member(primitive, "attributes");
      if (!document_.has(attributes, "POSITION")) document_.refuse(primitive, "/attributes/POSITION is missing");
      Mesh mesh;
      mesh.name = document_.text(node, "name");
      read_attribute(attributes, "POSITION", mesh.positions, mesh.positions.size());
      const std::size_t count = mesh.positions.size();
      read_attribute(attributes, "NORMAL", mesh.normals, count);
      read_attribute(attributes, "TEXCOORD_0", mesh.uvs, count);
      read_attribute(attributes, "TANGENT", mesh.tangents, count);
      read_triangles(primitive, mode, mesh);
      bytes_ += count * 48 + mesh.triangles.size() * sizeof(mesh.triangles[0]);
      if (bytes_ > kMostMeshBytes) document_.refuse(primitive, ": with it the meshes of the file take more than 8 GB");
      out.push_back({out_.meshes.size(), material_of(primitive)});
      out_.meshes.push_back(std::move(mesh));
    }
  }

  template <class V>
  void read_attribute(const Node& attributes, const char* name, std::vector<V>& out, std::size_t count) const {
    if (!document_.has(attributes, name)) return;
    out = document_.vectors<V>(document_.whole(attributes, name, 0), attributes);
    if (count != 0 && out.size() != count)
      document_.refuse(attributes, "/" + std::string(name) + " has " + std::to_string(out.size()) +
                                       " values, but there are " + std::to_string(count) + " positions");
  }

  void read_triangles(const Node& primitive, std::size_t mode, Mesh& mesh) const {
    const std::size_t positions = mesh.positions.size();
    std::vector<Index> corners;
    if (document_.has(primitive, "indices")) {
      corners = document_.indices(document_.whole(primitive, "indices", 0), primitive);
      for (const Index corner : corners)
        if (corner >= positions)
          document_.refuse(primitive, "/indices names vertex " + std::to_string(corner) + ", but there are " +
                                          std::to_string(positions));
    } else {
      corners.resize(positions);
      for (std::size_t i = 0; i < positions; ++i) corners[i] = static_cast<Index>(i);
    }
    if (mode == 4) {
      mesh.triangles.resize(corners.size() / 3);
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        mesh.triangles[i] = {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
      return;
    }
    for (std::size_t i = 2; i < corners.size(); ++i) {
      if (mode == 6) mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
      else if (i % 2 == 0) mesh.triangles.push_back({corners[i - 2], corners[i - 1], corners[i]});
      else mesh.triangles.push_back({corners[i - 1], corners[i - 2], corners[i]});
    }
  }

  Index material_of(const Node& primitive) {
    if (!document_.has(primitive, "material")) return kNone;
    const Node node = document_.named(primitive, "material", "materials");
    Index& at = materials_[document_.whole(primitive, "material", 0)];
    if (at == kNone) {
      out_.materials.push_back(gltf_material(document_, node, loading_));
      at = static_cast<Index>(out_.materials.size() - 1);
    }
    return at;
  }

  void read_camera(const Node& node, const std::string& name, const glm::dmat4& world) {
    const Node lens = document_.member(node, "perspective");
    if (!lens) return loading_.repair("orthographic cameras left out", document_.source());
    Camera out;
    out.name = name.empty() ? document_.text(node, "name") : name;
    const double angle = document_.number(lens, "yfov", 0.7);
    const double aspect = document_.number(lens, "aspectRatio", 1);
    if (!(angle > 1e-5 && angle < 3.14))
      document_.refuse(lens, "/yfov = " + files::number_text(angle) + " is no angle below pi");
    if (!(aspect > 0.01 && aspect < 100))
      document_.refuse(lens, "/aspectRatio = " + files::number_text(aspect) + " is outside [0.01, 100]");
    out.height = 512;
    out.width = std::max(1, static_cast<int>(std::lround(512 * aspect)));
    out.focal_x = out.focal_y = 256 / std::tan(angle / 2);
    out.center_x = 0.5 * out.width;
    out.center_y = 256;
    glm::dmat4 frame(1);
    for (int c = 0; c < 3; ++c) {
      const double length = glm::length(glm::dvec3(world[c]));
      if (!(length > 1e-12)) return loading_.repair("cameras scaled to nothing left out", document_.source());
      frame[c] = world[c] / length;
    }
    frame[3] = world[3];
    out.world_from_camera = glm::mat4(frame);
    out_.cameras.push_back(out);
  }

  void read_light(const Node& user, const std::string& name, const glm::dmat4& world) {
    const Node all = document_.member(document_.member(document_.root(), "extensions"), "KHR_lights_punctual");
    const Node node = document_.item(all, "lights", document_.whole(user, "light", 0), user);
    Light out;
    out.name = name.empty() ? document_.text(node, "name") : name;
    const auto color = document_.numbers(node, "color", {1, 1, 1});
    const double strength = document_.number(node, "intensity", 1) / kLumensPerWatt;
    const glm::vec3 power(color[0] * strength, color[1] * strength, color[2] * strength);
    for (int c = 0; c < 3; ++c)
      if (!(power[c] >= 0 && power[c] <= 1e12f))
        document_.refuse(node, "/intensity times /color is negative or beyond 1e12");
    const double range = document_.number(node, "range", std::numeric_limits<double>::infinity());
    if (!(range > 0)) document_.refuse(node, "/range = " + files::number_text(range) + "; expected above 0");
    out.range = static_cast<float>(std::min(range, 1e30)) > kFarthest ? kForever : static_cast<float>(range);
    const glm::vec3 position(world[3]);
    const glm::dvec3 ahead = -glm::dvec3(world[2]);
    const bool has_direction = glm::length(ahead) > 1e-12;
    const glm::vec3 direction = has_direction ? glm::vec3(glm::normalize(ahead)) : glm::vec3(0, 0, -1);
    const std::string type = document_.text(node, "type");
    if (type == "point") {
      out.shape = PointLight{position, power};
    } else if (type == "directional") {
      out.shape = DirectionalLight{direction, power};
    } else if (type == "spot") {
      const Node cone = document_.member(node, "spot");
      const double inner = document_.number(cone, "innerConeAngle", 0),
                   outer = document_.number(cone, "outerConeAngle", std::numbers::pi / 4);
      if (!(inner >= 0 && inner <= outer && outer > 0 && outer <= std::numbers::pi))
        document_.refuse(node, "/spot: innerConeAngle and outerConeAngle are not in the order of 0 to pi");
      out.shape = SpotLight{position, direction, power, static_cast<float>(inner), static_cast<float>(outer)};
    } else {
      document_.refuse(node, "/type = " + in_quotes(type) + "; expected point, spot or directional");
    }
    out_.lights.push_back(out);
  }

  const GltfDocument& document_;
  const std::string& part_;
  Loading& loading_;
  bool has_part_ = false;
  std::size_t bytes_ = 0;
  MeshFile out_;
  std::vector<Index> materials_;
  std::vector<std::optional<std::vector<Primitive>>> primitives_;
};

}  // namespace

MeshFile gltf_of(std::string_view bytes, const std::filesystem::path& file, const std::string& part, Loading& loading) {
  const GltfDocument document(bytes, file, loading);
  return GltfReader(document, part, loading).mesh_file();
}

}  // namespace likeness::scene
