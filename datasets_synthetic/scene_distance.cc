#include <cmath>
#include <numbers>

#include "datasets_synthetic/scene.h"
#include "datasets_synthetic/scene_files.h"
#include "datasets_synthetic/scene_shapes.h"

namespace likeness::datasets_synthetic {
namespace {

using std::numbers::pi;

// Normals of a height over the unit square that repeats at its edges: slopes by differences.
template <class Height>
SceneJson normals(SceneFiles& files, const char* name, int side, double height, const Height& at) {
  return files.add_texture(name, side, side, 3, [=](double u, double v, float* channels) {
    const double step = 0.5 / side;
    const double x = height * (at(u - step, v) - at(u + step, v)) / (2 * step);
    const double y = height * (at(u, v + step) - at(u, v - step)) / (2 * step);  // v runs down
    const double length = std::sqrt(x * x + y * y + 1);
    channels[0] = static_cast<float>(0.5 + 0.5 * x / length);
    channels[1] = static_cast<float>(0.5 + 0.5 * y / length);
    channels[2] = static_cast<float>(0.5 + 0.5 / length);
  });
}

SceneJson scaled(SceneJson texture, double u, double v) {
  texture["uv_scale"] = {u, v};
  return texture;
}

}  // namespace

void make_distance(const SceneOptions& options, SceneFiles& files) {
  files.add_camera({{"name", "front"},
                    {"width", options.width},
                    {"height", options.height},
                    {"position", {0, 2.2, 5}},
                    {"target", {0, 0.2, -4}},
                    {"fov_deg", 32}});
  files.add_shape("sphere", {{"shape", "sphere"}});
  files.add_shape("plane", {{"shape", "plane"}});

  const auto seed = static_cast<unsigned>(options.seed);
  const SceneJson hammered = normals(files, "hammered", 256, 0.012, [=](double u, double v) {
    return noise(16 * (u + 2), 16 * (v + 2), 31 + seed, 16) + noise(16 * (v + 2), 16 * (u + 2), 47 + seed, 16);
  });
  const SceneJson plaster = normals(files, "plaster", 256, 0.012, [](double u, double v) {
    return std::sin(2 * pi * 16 * u) * std::cos(2 * pi * 16 * v);
  });
  const SceneJson tiles = normals(files, "tiles", 256, 0.02, [](double u, double v) {
    const auto edge = [](double x) { return std::pow(std::abs(std::cos(pi * 4 * x)), 12.0); };
    return -std::max(edge(u), edge(v));
  });
  const SceneJson checks = files.add_texture("checks", 256, 256, 3, [](double u, double v, float* channels) {
    const bool is_dark = (static_cast<int>(4 * u) + static_cast<int>(4 * v)) % 2 == 0;
    for (int k = 0; k < 3; ++k) channels[k] = is_dark ? 0.08f : 0.5f - 0.08f * static_cast<float>(k);
  });

  files.add_material("floor", {{"parameters", {{"base_color", scaled(checks, 30, 30)}, {"roughness", 0.3}}},
                               {"normal_map", scaled(tiles, 30, 30)}});
  files.add_material("metal", {{"parameters", {{"base_color", {0.9, 0.7, 0.35}}, {"metallic", 1}, {"roughness", 0.25}}},
                               {"normal_map", scaled(hammered, 4, 2)}});
  files.add_material("lacquer", {{"parameters", {{"base_color", {0.45, 0.03, 0.02}}, {"roughness", 0.15}}},
                                 {"normal_map", scaled(hammered, 4, 2)}});
  files.add_material("plaster",
                     {{"parameters", {{"base_color", {0.75, 0.73, 0.7}}, {"roughness", 0.7}, {"specular", 0.1}}},
                      {"normal_map", scaled(plaster, 8, 4)}});

  files.add_instance("plane", "floor", {{"scale", {60, 1, 60}}, {"translate", {0, 0, -27}}});
  constexpr const char* kColumns[]{"metal", "lacquer", "plaster"};
  double z = 0;
  for (int row = 0; row < 7; ++row, z = 1.75 * z - 1.5)
    for (int column = 0; column < 3; ++column)
      files.add_instance("sphere", kColumns[column],
                         {{"scale", 0.5}, {"translate", {1.2 * (column - 1), 0.5, std::round(100 * z) / 100}}});

  // Low and from the side, so that bumps have lit and dark sides.
  files.add_light({{"type", "directional"}, {"name", "sun"}, {"direction", {-0.75, -0.45, -0.5}}, {"strength", 5}});
  files.set_environment({{"radiance", {0.06, 0.07, 0.09}}});
}

}  // namespace likeness::datasets_synthetic
