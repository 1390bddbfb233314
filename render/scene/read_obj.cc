#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/files/files.h"
#include "render/scene/format.h"
#include "render/scene/mesh_file.h"
#include "render/scene/words.h"

// Wavefront OBJ: v, vt, vn, f (polygons become fans), usemtl, mtllib, o, g. Lines, points, curves and smoothing groups
// are read over. One mesh for each material, in which a corner's position, texture and normal make one vertex.
namespace likeness::scene {
namespace {

using files::in_quotes;

struct Corner {
  Index v = kNone, vt = kNone, vn = kNone;
};

struct Group {
  std::string material;
  std::vector<std::array<Corner, 3>> triangles;
};

constexpr std::size_t kMostGroups = 100'000;

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::filesystem::path& file, const std::string& part, Loading& loading)
      : words_(bytes), file_(file), source_(file.string()), part_(part), loading_(loading), is_taken_(part.empty()) {
    group_ = &group_of("");
    for (; !words_.is_at_end(); words_.skip_line()) read_line();
  }

  MeshFile mesh_file() {
    if (!part_.empty() && !has_part_)
      throw files::InputError(source_ + ": has no object or group " + in_quotes(part_) +
                              near_text(part_, {part_names_.begin(), part_names_.end()}));
    MeshFile out;
    read_libraries(out);
    std::map<std::string_view, Index> materials;
    for (std::size_t i = 0; i < out.materials.size(); ++i) materials[out.materials[i].name] = static_cast<Index>(i);
    std::vector<Index> head(positions_.size(), kNone);  // the first vertex of a mesh at a position
    for (const auto& group : groups_) {
      if (group->triangles.empty()) continue;
      MeshFile::Part part{group->material, out.meshes.size(), kNone, glm::dmat4(1)};
      if (const auto at = materials.find(group->material); at != materials.end()) part.material = at->second;
      if (part.material == kNone && !group->material.empty() && !libraries_.empty())
        loading_.repair("materials that no library has: defaults", source_ + " (" + json::plain(group->material) + ")");
      out.meshes.push_back(mesh_of(*group, head));
      group->triangles = {};
      out.parts.push_back(std::move(part));
    }
    if (out.parts.empty()) throw files::InputError(source_ + ": has no faces; expected a mesh of triangles");
    return out;
  }

 private:
  [[noreturn]] void refuse(const std::string& text) const {
    throw files::InputError(source_ + ":" + std::to_string(words_.line()) + ": " + text);
  }

  Group& group_of(const std::string& material) {
    const auto [at, fresh] = group_index_.try_emplace(material, groups_.size());
    if (fresh) {
      if (groups_.size() == kMostGroups) refuse("names more than " + std::to_string(kMostGroups) + " materials");
      groups_.push_back(std::make_unique<Group>(Group{material, {}}));
    }
    return *groups_[at->second];
  }

  void read_line() {
    const std::string_view word = words_.next();
    if (word == "v") positions_.push_back(numbers<glm::vec3>(word, 3));
    else if (word == "vt") uvs_.push_back(numbers<glm::vec2>(word, 1));
    else if (word == "vn") normals_.push_back(numbers<glm::vec3>(word, 3));
    else if (word == "f") read_face();
    else if (word == "usemtl") group_ = &group_of(std::string(words_.rest()));
    else if (word == "mtllib") read_library_name();
    else if (word == "o" || word == "g") read_part();
  }

  void read_library_name() {
    libraries_.insert(std::string(words_.rest()));
    if (libraries_.size() > 64) refuse("names more than 64 material libraries");
  }

  template <class V>
  V numbers(std::string_view what, int least) {
    V out(0);
    for (int i = 0; i < V::length(); ++i) {
      if (words_.number(out[i])) continue;
      const std::string_view word = words_.next();
      if (i < least || !word.empty())
        refuse(in_quotes(what) + " has the word " + in_quotes(word) + "; expected " + std::to_string(V::length()) +
               " numbers");
    }
    return out;
  }

  void read_part() {
    const std::string name(words_.rest());
    if (part_.empty()) return;
    is_taken_ = name == part_;
    has_part_ |= is_taken_;
    if (part_names_.size() < 1000) part_names_.insert(name);
  }

  // "7", "7/1", "7//3", "7/1/3", counted from 1, or from the end if negative.
  Corner corner(std::string_view word) const {
    const std::string_view whole = word;
    const auto take = [&](std::size_t count, const char* what) -> Index {
      long long number = 0;
      const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
      const auto size = static_cast<long long>(count);
      if (error != std::errc() || number == 0 || number > size || number < -size)
        refuse("the corner " + in_quotes(whole) + " names no " + what + "; there are " + std::to_string(count) +
               " before it");
      word.remove_prefix(static_cast<std::size_t>(stop - word.data()));
      return static_cast<Index>(number > 0 ? number - 1 : size + number);
    };
    Corner out;
    out.v = take(positions_.size(), "position");
    if (!word.empty() && word[0] == '/') {
      word.remove_prefix(1);
      if (!word.empty() && word[0] != '/') out.vt = take(uvs_.size(), "texture coordinate");
      if (!word.empty() && word[0] == '/') {
        word.remove_prefix(1);
        if (!word.empty()) out.vn = take(normals_.size(), "normal");
      }
    }
    if (!word.empty()) refuse("the corner " + in_quotes(whole) + " is not of the form 7/1/3");
    return out;
  }

  void read_face() {
    Corner first, last;
    int count = 0;
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next(), ++count) {
      const Corner next = corner(word);
      if (count >= 2 && is_taken_) group_->triangles.push_back({first, last, next});
      if (count == 0) first = next;
      last = next;
    }
    if (count < 3) refuse("a face has " + std::to_string(count) + " corners; expected three or more");
  }

  Mesh mesh_of(const Group& group, std::vector<Index>& head) const {
    Mesh out;
    std::vector<Corner> corners;
    std::vector<Index> next;  // the next vertex of this mesh at the same position
    bool has_uv = false, has_normal = false;
    const auto vertex = [&](const Corner& corner) {
      Index at = head[corner.v];
      for (; at != kNone; at = next[at])
        if (corners[at].vt == corner.vt && corners[at].vn == corner.vn) return at;
      at = static_cast<Index>(corners.size());
      corners.push_back(corner);
      next.push_back(head[corner.v]);
      head[corner.v] = at;
      has_uv |= corner.vt != kNone;
      has_normal |= corner.vn != kNone;
      return at;
    };
    out.triangles.reserve(group.triangles.size());
    for (const auto& t : group.triangles) {
      const Index a = vertex(t[0]), b = vertex(t[1]), c = vertex(t[2]);
      out.triangles.push_back({a, b, c});
    }
    out.positions.reserve(corners.size());
    if (has_uv) out.uvs.reserve(corners.size());
    if (has_normal) out.normals.reserve(corners.size());
    for (const Corner& corner : corners) {
      out.positions.push_back(positions_[corner.v]);
      if (has_uv) out.uvs.push_back(corner.vt == kNone ? glm::vec2(0) : uvs_[corner.vt]);
      if (has_normal) out.normals.push_back(corner.vn == kNone ? glm::vec3(0) : normals_[corner.vn]);
      head[corner.v] = kNone;
    }
    return out;
  }

  void read_libraries(MeshFile& out) const {
    for (const std::string& name : libraries_) {
      const std::filesystem::path library = file_.parent_path() / name;
      std::string bytes;
      try {
        bytes = loading_.bytes(library, std::size_t{64} << 20);
      } catch (const files::InputError&) {
        loading_.repair("material libraries that cannot be read: defaults", source_ + " (" + json::plain(name) + ")");
        continue;
      }
      read_mtl(bytes, library, loading_, out.materials);
    }
  }

  Words words_;
  const std::filesystem::path& file_;
  std::string source_;
  const std::string& part_;
  Loading& loading_;
  bool is_taken_, has_part_ = false;
  std::set<std::string> part_names_, libraries_;
  std::vector<glm::vec3> positions_, normals_;
  std::vector<glm::vec2> uvs_;
  std::map<std::string, std::size_t> group_index_;
  std::vector<std::unique_ptr<Group>> groups_;
  Group* group_ = nullptr;
};

}  // namespace

MeshFile obj_of(std::string_view bytes, const std::filesystem::path& file, const std::string& part, Loading& loading) {
  return ObjReader(bytes, file, part, loading).mesh_file();
}

}  // namespace likeness::scene
