#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "datasets_synthetic/scene.h"
#include "datasets_synthetic/scene_files.h"
#include "datasets_synthetic/scene_shapes.h"

namespace likeness::datasets_synthetic {
namespace {

using std::numbers::pi;

// The way the light travels that comes from `degrees` around the scene, a little from above.
SceneJson travel(double degrees) {
  const double turn = degrees * pi / 180, up = 20 * pi / 180;
  return {rounded(-std::sin(turn) * std::cos(up), 6), rounded(-std::sin(up), 6),
          rounded(-std::cos(turn) * std::cos(up), 6)};
}

void make_sphere(const SceneOptions& options, SceneFiles& files, const SceneJson& material) {
  files.add_camera({{"name", "front"},
                    {"width", options.width},
                    {"height", options.height},
                    {"position", {0, 0, 4}},
                    {"target", {0, 0, 0}},
                    {"fov_deg", 40}});
  files.add_shape("sphere", {{"shape", "sphere"}});
  files.add_material("surface", material);
  files.add_instance("sphere", "surface");
  files.set_environment({{"radiance", 1}});
}

}  // namespace

void make_spheres(const SceneOptions& options, SceneFiles& files) {
  constexpr int kColumns = 7;
  // A row: what grows from left to right, from none to strong.
  struct Row {
    const char* name;
    const char* parameter;
    double most;
  };
  constexpr std::array kRows{Row{"roughness", "roughness", 1}, Row{"diffuse_fresnel", "diffuse_fresnel", 8},
                             Row{"retroreflection", "retroreflection", 8},
                             Row{"smooth_terminator", "smooth_terminator", 1}};
  files.add_camera({{"name", "front"},
                    {"width", options.width},
                    {"height", options.height},
                    {"position", {0, 0, 20}},
                    {"target", {0, 0, 0}},
                    {"fov_deg", 11.5}});
  files.add_shape("sphere", {{"shape", "sphere"}});
  for (std::size_t r = 0; r < kRows.size(); ++r)
    for (int c = 0; c < kColumns; ++c) {
      const double share = static_cast<double>(c) / (kColumns - 1);
      // The effects of the other rows are off: an intensity of 1 is Lambert's.
      SceneJson parameters{{"base_color", {0.45, 0.28, 0.2}},
                           {"roughness", 0.5},
                           {"diffuse_fresnel", 1},
                           {"retroreflection", 1},
                           {"smooth_terminator", 0}};
      const double least = kRows[r].most > 1 ? 1 : 0;
      parameters[kRows[r].parameter] = rounded(least + (kRows[r].most - least) * share, 6);
      const std::string name = std::string(kRows[r].name) + "_" + std::to_string(c);
      files.add_material(name, {{"model", "callisto"}, {"parameters", parameters}});
      files.add_instance("sphere", name,
                         {{"scale", 0.3},
                          {"translate", {c - (kColumns - 1) / 2, rounded(1.35 - 0.9 * static_cast<double>(r), 6), 0}}});
    }
  for (int frame = 0; frame < options.frames; ++frame) {
    files.lights() = SceneJson::array();
    // pi W/m^2: a white Lambertian surface that faces the light has the radiance 1.
    files.add_light({{"type", "directional"},
                     {"name", "turning"},
                     {"direction", travel(options.light_deg + 360.0 * frame / options.frames)},
                     {"strength", rounded(pi, 6)},
                     {"movable", options.frames > 1}});
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "scene_%03d.json", frame);
    files.write(options.frames == 1 ? "scene.json" : name.data());
  }
}

void make_ggx_sphere(const SceneOptions& options, SceneFiles& files) {
  make_sphere(options, files, {{"model", "ggx"}, {"parameters", {{"f0", {1, 0.78, 0.34}}, {"roughness", 0.5}}}});
}

void make_plastic_sphere(const SceneOptions& options, SceneFiles& files) {
  make_sphere(options, files,
              {{"model", "callisto"},
               {"parameters", {{"base_color", {0.5, 0.1, 0.05}}, {"specular", 0.5}, {"roughness", 0.3}}}});
}

}  // namespace likeness::datasets_synthetic
