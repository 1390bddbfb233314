#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "datasets_synthetic/random.h"
#include "datasets_synthetic/scene.h"
#include "datasets_synthetic/scene_files.h"
#include "datasets_synthetic/scene_shapes.h"

namespace likeness::datasets_synthetic {
namespace {

using Corners = std::array<std::array<double, 3>, 4>;

// Quadrilaterals in millimetres, counter-clockwise seen from where they face; flat, in metres.
scene::Mesh quads(const std::vector<Corners>& faces) {
  scene::Mesh mesh;
  for (const Corners& face : faces) {
    const auto first = static_cast<scene::Index>(mesh.positions.size());
    for (const auto& p : face) mesh.positions.emplace_back(p[0] / 1000, p[1] / 1000, p[2] / 1000);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

// A block by the corners of its top in the order of the published tables (seen from above in a frame of x to the left
// and z away from the viewer), standing on the floor.
scene::Mesh block(double height, const std::array<std::array<double, 2>, 4>& top) {
  std::vector<Corners> faces;
  const auto at = [&](std::size_t i, double y) { return std::array<double, 3>{top[i % 4][0], y, top[i % 4][1]}; };
  faces.push_back({at(0, height), at(1, height), at(2, height), at(3, height)});
  for (std::size_t i = 0; i < 4; ++i) faces.push_back({at(i + 1, height), at(i, height), at(i, 0), at(i + 1, 0)});
  return quads(faces);
}

SceneJson matte(double r, double g, double b) {
  return {{"model", "lambert"}, {"parameters", {{"base_color", {r, g, b}}}}};
}

}  // namespace

// The measurements of Cornell University's Program of Computer Graphics ("Cornell Box Data"), millimetres; the
// reflectances and the lamp are the usual RGB of their spectra. The lamp hangs half a millimetre below the ceiling, in
// whose plane its table has it.
void make_cornell(const SceneOptions& options, SceneFiles& files) {
  files.add_camera({{"name", "cornell"},
                    {"width", options.width},
                    {"height", options.height},
                    {"position", {0.278, 0.273, -0.8}},
                    {"target", {0.278, 0.273, 0}},
                    {"focal_mm", 35},
                    {"sensor_mm", 25}});
  files.add_mesh("white", quads({
                              {{{552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2}}},
                              {{{556, 548.8, 0}, {556, 548.8, 559.2}, {0, 548.8, 559.2}, {0, 548.8, 0}}},
                              {{{549.6, 0, 559.2}, {0, 0, 559.2}, {0, 548.8, 559.2}, {556, 548.8, 559.2}}},
                          }));
  files.add_mesh("right", quads({{{{0, 0, 559.2}, {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2}}}}));
  files.add_mesh("left", quads({{{{552.8, 0, 0}, {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0}}}}));
  files.add_mesh("short_block", block(165, {{{130, 65}, {82, 225}, {240, 272}, {290, 114}}}));
  files.add_mesh("tall_block", block(330, {{{423, 247}, {265, 296}, {314, 456}, {472, 406}}}));
  files.add_material("white", matte(0.725, 0.71, 0.68));
  files.add_material("green", matte(0.14, 0.45, 0.091));
  files.add_material("red", matte(0.63, 0.065, 0.05));
  files.add_instance("white", "white");
  files.add_instance("right", "green");
  files.add_instance("left", "red");
  files.add_instance("short_block", "white");
  files.add_instance("tall_block", "white");
  files.add_light({{"type", "rectangle"},
                   {"name", "lamp"},
                   {"position", {0.278, 0.5483, 0.2795}},
                   {"half_u", {0.065, 0, 0}},
                   {"half_v", {0, 0, 0.0525}},
                   {"strength", {17, 12, 4}}});
  files.set_view({{"ev", 1}});
}

void make_corridor(const SceneOptions& options, SceneFiles& files) {
  const double length = std::max(12.0, 0.4 * options.lights), half_width = 1.6, height = 3;
  const double middle = rounded(-length / 2, 4);
  files.add_camera({{"name", "entrance"},
                    {"width", options.width},
                    {"height", options.height},
                    {"position", {0.3, 1.6, -0.3}},
                    {"target", {0, 1.3, -6}},
                    {"fov_deg", 55}});
  const auto box = [&](const std::string& name, double x, double y, double z) {
    files.add_shape(name, {{"shape", "box"}, {"size", {x, y, z}}});
  };
  box("slab", 2 * half_width, 0.1, length);
  box("wall", 0.1, height, length);
  box("end", 2 * half_width, height, 0.1);
  box("pillar", 0.35, height, 0.35);
  files.add_material("floor", {{"parameters", {{"base_color", {0.25, 0.22, 0.2}}, {"roughness", 0.25}}}});
  files.add_material("plaster", {{"parameters", {{"base_color", {0.7, 0.68, 0.64}}, {"roughness", 0.9}}}});
  files.add_material("brass",
                     {{"parameters", {{"base_color", {0.9, 0.7, 0.4}}, {"metallic", 1}, {"roughness", 0.35}}}});
  files.add_instance("slab", "floor", {{"translate", {0, -0.05, middle}}});
  files.add_instance("slab", "plaster", {{"translate", {0, height + 0.05, middle}}});
  files.add_instance("wall", "plaster", {{"translate", {-half_width - 0.05, height / 2, middle}}});
  files.add_instance("wall", "plaster", {{"translate", {half_width + 0.05, height / 2, middle}}});
  files.add_instance("end", "plaster", {{"translate", {0, height / 2, 0.05}}});
  files.add_instance("end", "plaster", {{"translate", {0, height / 2, rounded(-length - 0.05, 4)}}});
  const int pillars = static_cast<int>(length / 2);
  for (int i = 0; i < pillars; ++i)
    files.add_instance("pillar", i % 3 == 0 ? "brass" : "plaster",
                       {{"translate", {i % 2 == 0 ? -1.4 : 1.4, height / 2, -1.5 - 2.0 * i}}});

  Random random(options.seed, 1);
  constexpr std::array kKinds{"point", "spot", "sphere", "rectangle", "disk"};
  for (int i = 0; i < options.lights; ++i) {
    const double z = rounded(-length * (i + 0.2 + 0.6 * random.uniform()) / options.lights, 4);
    const double x = rounded((i % 2 == 0 ? -1 : 1) * (0.3 + 0.7 * random.uniform()), 4);
    const double y = rounded(2.2 + 0.5 * random.uniform(), 4);
    SceneJson color;
    const double hue = random.uniform();
    for (const double phase : {0.0, 1.0 / 3, 2.0 / 3}) {
      const double wave = 0.5 + 0.5 * std::cos(2 * std::numbers::pi * (hue - phase));
      color.push_back(rounded(0.25 + 0.75 * wave, 4));
    }
    const std::string type = kKinds[static_cast<std::size_t>(i) % kKinds.size()];
    SceneJson light{{"type", type}, {"position", {x, y, z}}, {"color", color}, {"range", 5}};
    light["movable"] = i % 5 == 4;
    if (type == "spot") {
      light["target"] = {rounded(-x, 4), 0, rounded(z - 1, 4)};
      light["inner_deg"] = 20;
      light["outer_deg"] = 40;
      light["strength"] = 3;
    } else if (type == "point") {
      light["strength"] = 0.8;
    } else {
      light["unit"] = "W";
      light["strength"] = type == "sphere" ? 10 : 5;
      if (type == "rectangle") light["size"] = {0.4, 0.15};
      else light["radius"] = type == "sphere" ? 0.05 : 0.12;
    }
    files.add_light(light);
  }
}

}  // namespace likeness::datasets_synthetic
