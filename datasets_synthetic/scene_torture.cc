#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "datasets_synthetic/random.h"
#include "datasets_synthetic/scene.h"
#include "datasets_synthetic/scene_files.h"
#include "datasets_synthetic/scene_shapes.h"

namespace likeness::datasets_synthetic {
namespace {

using std::numbers::pi;

// A fan of triangles whose height is 1e-5 of their length.
scene::Mesh needles(Random& random) {
  scene::Mesh mesh;
  for (int i = 0; i < 300; ++i) {
    const double phi = 2 * pi * random.uniform(), up = random.uniform() * 2 - 1;
    const glm::dvec3 along(std::sqrt(1 - up * up) * std::cos(phi), up, std::sqrt(1 - up * up) * std::sin(phi));
    const glm::dvec3 across = glm::dvec3(-along.z, 0, along.x) * 1e-5;
    const auto first = static_cast<scene::Index>(mesh.positions.size());
    mesh.positions.emplace_back(-0.5 * along);
    mesh.positions.emplace_back(0.5 * along);
    mesh.positions.emplace_back(0.5 * along + across);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

// A quarter of it cannot be traced: repeated corners, corners on a line, corners that are no numbers.
scene::Mesh broken() {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  scene::Mesh mesh;
  mesh.positions = {{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0},
                    {0, 0, 0},         {nan, 0, 0},      {0, 3e38f, 0}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 2}, {0, 0, 0}, {0, nan, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 0, 1}, {0, 4, 2}, {0, 1, 5}, {1, 2, 6}};
  return mesh;
}

void add_cameras(const SceneOptions& options, SceneFiles& files) {
  const auto camera = [&](const char* name, const SceneJson& position, const SceneJson& target, double fov) {
    files.add_camera({{"name", name},
                      {"width", options.width},
                      {"height", options.height},
                      {"position", position},
                      {"target", target},
                      {"fov_deg", fov}});
  };
  camera("whole", {0, 2.2, 7}, {0, 0.9, 0}, 40);
  camera("grazing", {0, 1e-3, 6}, {0, 0, -20}, 30);
  camera("inside", {-2.4, 0.7, 0}, {-2.4, 0.7, -1}, 100);
  camera("far", {0, 2e4, 3e4}, {0, 0, 0}, 0.01);
  camera("against_the_leaf", {2.4, 0.8, 1.0001}, {2.4, 0.8, 1}, 60);
}

void add_materials(SceneFiles& files) {
  const auto callisto = [&](const char* name, const SceneJson& parameters) {
    files.add_material(name, {{"parameters", parameters}});
  };
  callisto("ground", {{"base_color", 0.5}, {"roughness", 0.1}});
  callisto("mirror", {{"base_color", 1}, {"metallic", 1}, {"roughness", 0}});
  callisto("near_mirror", {{"base_color", 0.9}, {"metallic", 1}, {"roughness", 0.01}});  // alpha = 1e-4
  callisto("white", {{"base_color", 1}, {"specular", 1}, {"roughness", 1}});
  callisto("black", {{"base_color", 0}, {"specular", 0}, {"roughness", 0}});
  // As strong as it may be and still return no more light than it gets: 256 is allowed, but then light grows as it
  // bounces, and no picture converges.
  callisto("extreme", {{"base_color", {0.1, 0, 0.05}},
                       {"metallic", 0.5},
                       {"diffuse_fresnel", 16},
                       {"retroreflection", 16},
                       {"smooth_terminator", -1},
                       {"dual_specular_opacity", 1},
                       {"dual_specular_roughness_scale", 16}});
  files.add_material("glow",
                     {{"parameters", {{"base_color", 0}}}, {"emission", {1e4, 8e3, 6e3}}, {"two_sided", false}});

  SceneJson speckles = files.add_texture("not_a_number", 16, 16, 1, [](double u, double v, float* channels) {
    const int cell = static_cast<int>(16 * u) + static_cast<int>(16 * v);
    channels[0] = cell % 7 == 0   ? std::numeric_limits<float>::quiet_NaN()
                  : cell % 7 == 1 ? std::numeric_limits<float>::infinity()
                                  : 0.4f;
  });
  files.add_material("speckled", {{"parameters", {{"base_color", 0.6}, {"roughness", speckles}}}});

  // A leaf of holes and lobes, its light from both sides.
  const SceneJson cut = files.add_texture("leaf_opacity", 128, 128, 1, [](double u, double v, float* channels) {
    const double x = 2 * u - 1, y = 2 * v - 1, phi = std::atan2(y, x);
    const bool is_leaf = std::hypot(x, y) < 0.75 + 0.2 * std::cos(7 * phi);
    const bool is_hole = noise(9 * u, 9 * v, 21) > 0.45;
    channels[0] = is_leaf && !is_hole ? 1.0f : 0.0f;
  });
  const SceneJson veins = files.add_texture("leaf_color", 128, 128, 3, [](double u, double v, float* channels) {
    const double x = 2 * u - 1, y = 2 * v - 1;
    const double vein = std::abs(std::sin(3.5 * std::atan2(y, x))) < 0.08 ? 0.25 : 0;
    channels[0] = static_cast<float>(0.08 + vein);
    channels[1] = static_cast<float>(0.3 + vein);
    channels[2] = 0.04f;
  });
  files.add_material("leaf", {{"parameters", {{"base_color", veins}, {"roughness", 0.4}}}, {"opacity", cut}});

  // Normals that lean as far as a texel can, another set for the diffuse light.
  const auto waves = [&](const char* name, double count, double lean) {
    return files.add_texture(name, 64, 64, 3, [=](double u, double v, float* channels) {
      const double x = lean * std::sin(2 * pi * count * u), y = lean * std::cos(2 * pi * count * v);
      const double z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
      channels[0] = static_cast<float>(0.5 + 0.5 * x);
      channels[1] = static_cast<float>(0.5 + 0.5 * y);
      channels[2] = static_cast<float>(0.5 + 0.5 * z);
    });
  };
  files.add_material("dual_normals", {{"parameters", {{"base_color", {0.6, 0.4, 0.3}}, {"roughness", 0.2}}},
                                      {"normal_map", waves("steep_normals", 8, 0.7)},
                                      {"diffuse_normal_map", waves("gentle_normals", 2, 0.3)}});
}

void add_lights(SceneFiles& files) {
  files.add_light({{"type", "sphere"},
                   {"name", "pinpoint"},
                   {"position", {-1, 3, 2}},
                   {"radius", 1e-6},
                   {"unit", "W"},
                   {"strength", 80}});
  files.add_light({{"type", "point"}, {"name", "at_the_ground"}, {"position", {1.2, 1e-4, 1.5}}, {"strength", 1e-3}});
  files.add_light(
      {{"type", "point"}, {"name", "of_no_reach"}, {"position", {0, 1, 0}}, {"strength", 5}, {"range", 1e-3}});
  files.add_light({{"type", "spot"},
                   {"name", "hard_edge"},
                   {"position", {3, 4, 3}},
                   {"target", {1, 0, 0}},
                   {"inner_deg", 9.999},
                   {"outer_deg", 10},
                   {"strength", 60}});
  files.add_light(
      {{"type", "directional"}, {"name", "along_the_ground"}, {"direction", {-1, -1e-4, -0.3}}, {"strength", 0.5}});
  files.add_light({{"type", "rectangle"},
                   {"name", "sliver"},
                   {"position", {0, 2.5, -3}},
                   {"target", {0, 0, 0}},
                   {"size", {6, 1e-4}},
                   {"strength", 1e4},
                   {"two_sided", true}});
  files.add_light({{"type", "disk"}, {"name", "switched_off"}, {"position", {0, 4, 0}}, {"strength", 0}});
  files.set_environment({{"radiance", {0.2, 0.25, 0.35}}});
}

}  // namespace

void make_torture(const SceneOptions& options, SceneFiles& files) {
  Random random(options.seed, 3);
  add_cameras(options, files);
  add_materials(files);
  files.add_shape("sphere", {{"shape", "sphere"}});
  files.add_shape("faceted", {{"shape", "faceted_sphere"}, {"segments", 3}});
  files.add_shape("plane", {{"shape", "plane"}});
  files.add_shape("box", {{"shape", "box"}});
  files.add_mesh("needles", needles(random));
  files.add_mesh("broken", broken());

  const auto sphere = [&](const char* material, double x, double y, double z, double radius) {
    files.add_instance("sphere", material, {{"scale", radius}, {"translate", {x, y, z}}});
  };
  files.add_instance("plane", "ground", {{"scale", {1e4, 1, 1e4}}});
  files.add_instance("plane", "white", {{"scale", {2, 1, 2}}, {"translate", {0, 1e-6, -2}}});  // all but in the ground
  files.add_instance("plane", "black", {{"scale", {1, 1, 1}}, {"translate", {0, 1e-6, -2}}});  // in the other
  sphere("white", 2e5, 1e5, -1e6, 1e5);                                                        // a moon
  sphere("glow", 0, 0.3, 3, 1e-5);                                                             // a spark
  sphere("mirror", -1.2, 0.5, 0, 0.5);
  sphere("near_mirror", 0, 0.5, 0, 0.5);
  sphere("extreme", 1.2, 0.5, 0, 0.5);
  sphere("ground", -2.4, 0.7, 0, 0.7);  // with a camera inside
  sphere("white", -2.4, 0.7, 0, 0.7);   // and itself again
  sphere("dual_normals", -1.2, 0.35, 1.6, 0.35);
  sphere("speckled", 0, 0.35, 1.6, 0.35);
  sphere("black", 0.9, 0.35, 1.6, 0.35);
  files.add_instance("faceted", "near_mirror", {{"scale", {0.3, 1e-4, 0.3}}, {"translate", {2, 0.2, 1.6}}});
  files.add_instance("box", "mirror", {{"scale", {-0.4, 0.4, 0.4}}, {"translate", {2.9, 0.2, 1.2}}});  // a mirror image
  files.add_instance("needles", "glow", {{"translate", {-2.6, 2.2, 0}}});
  files.add_instance("broken", "white", {{"translate", {2.6, 2.2, -0.5}}});
  for (int i = 0; i < 5; ++i)
    files.add_instance("plane", "leaf",
                       {{"scale", 0.9},
                        {"rotate_deg", {90, rounded(20 * random.uniform(), 5), 0}},
                        {"translate", {2.4, 0.8, rounded(1 - 0.002 * i, 5)}}});
  // Shadows between two walls a hair apart.
  files.add_instance("box", "ground", {{"scale", {0.02, 1.5, 1.5}}, {"translate", {3.6, 0.75, -1}}});
  files.add_instance("box", "white", {{"scale", {0.02, 1.5, 1.5}}, {"translate", {3.6202, 0.75, -1}}});
  add_lights(files);
}

}  // namespace likeness::datasets_synthetic
