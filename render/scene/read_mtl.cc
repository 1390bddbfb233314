#include <algorithm>
#include <cmath>

#include "render/files/files.h"
#include "render/scene/mesh_file.h"
#include "render/scene/words.h"

// The material library of an OBJ, as Callisto: base color Kd and map_Kd, roughness of Pr and map_Pr or else of Ns,
// metallic of Pm and map_Pm, emission of Ke and map_Ke, normals of norm, cut-outs of map_d. Ks, Ka, Tf and illum are read
// over, and so are bump and disp, which hold heights.
namespace likeness::scene {
namespace {

using Callisto = brdf::Callisto<double>;

// The file that an entry names, behind its options ("-s 1 1 1 -bm 0.5 wood.png"): options begin with a minus and go on
// for as long as there are numbers, or the words on and off.
std::string_view file_name(Words& words) {
  for (;;) {
    Words before = words;
    const std::string_view word = words.next();
    if (word.size() < 2 || word[0] != '-') {
      words = before;
      return words.rest();
    }
    for (;;) {
      before = words;
      double number;
      if (words.number(number)) continue;
      const std::string_view next = words.next();
      if (next == "on" || next == "off") continue;
      words = before;
      break;
    }
  }
}

double within(double x, double low, double high) { return x >= low && x <= high ? x : x > high ? high : low; }

}  // namespace

void read_mtl(std::string_view bytes, const std::filesystem::path& file, Loading& loading, std::vector<Material>& out) {
  const std::string source = file.string();
  bool has_roughness = false;
  Words words(bytes);
  const auto numbers = [&](std::string_view key) {
    glm::dvec3 value(0);
    for (int i = 0; i < 3; ++i)
      if (!words.number(value[i])) {
        if (i == 0)
          throw files::InputError(source + ":" + std::to_string(words.line()) + ": " + files::in_quotes(key) +
                                  " has the word " + files::in_quotes(words.next()) + "; expected a number");
        value = glm::dvec3(value[0]);
        break;
      }
    return value;
  };
  const auto texture = [&](bool is_color, bool is_light) {
    Texture t;
    t.image = loading.image(file.parent_path() / std::string(file_name(words)), is_light);
    t.transfer = is_color ? Transfer::kSrgb : Transfer::kLinear;
    return t;
  };
  for (; !words.is_at_end(); words.skip_line()) {
    const std::string_view key = words.next();
    if (key == "newmtl") {
      out.push_back({});
      out.back().name = std::string(words.rest());
      has_roughness = false;
      if (out.size() > 100'000) throw files::InputError(source + ": has more than 100000 materials");
      continue;
    }
    if (out.empty()) continue;
    Material& material = out.back();
    auto& callisto = std::get<Callisto>(material.brdf);
    const auto map = [&](std::string_view name, bool is_color) {
      bind_texture(material, name, texture(is_color, false));
    };
    if (key == "Kd") {
      const glm::dvec3 c = glm::dvec3(numbers(key));
      callisto.base_color = brdf::Rgb<double>{within(c.x, 0, 1), within(c.y, 0, 1), within(c.z, 0, 1)};
    } else if (key == "Pr") {
      callisto.roughness = within(numbers(key).x, 0, 1);
      has_roughness = true;
    } else if (key == "Ns" && !has_roughness) {
      // The exponent n of Blinn-Phong is that of a slope roughness alpha with n = 2 / alpha^2 - 2 (Walter 2007, section
      // 5.2, of Beckmann), and roughness is the root of alpha.
      callisto.roughness = within(std::pow(2 / (std::max(numbers(key).x, 0.0) + 2), 0.25), 0, 1);
    } else if (key == "Pm") {
      callisto.metallic = within(numbers(key).x, 0, 1);
    } else if (key == "Ke") {
      const glm::dvec3 e = numbers(key);
      material.emission = glm::vec3(within(e.x, 0, 1e12), within(e.y, 0, 1e12), within(e.z, 0, 1e12));
    } else if (key == "map_Kd") {
      map("base_color", true);
    } else if (key == "map_Pr") {
      map("roughness", false);
    } else if (key == "map_Pm") {
      map("metallic", false);
    } else if (key == "map_Ke") {
      material.emission_map = texture(true, true);
      if (material.emission == glm::vec3(0)) material.emission = glm::vec3(1);
    } else if (key == "norm") {
      material.normal_map = texture(false, false);
    } else if (key == "map_d") {
      material.opacity = texture(false, false);
    }
  }
}

}  // namespace likeness::scene
