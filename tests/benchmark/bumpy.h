#pragma once

#include <cmath>
#include <utility>

#include "tests/render/runtime/scenes.h"

// The scene that the renderer's speed is measured on.
namespace likeness::benchmark_scene {

inline constexpr int kSide = 1024;  // of the picture whose rays are traced

// A closed, bumpy mesh above a floor: 70 802 triangles, which about half of the rays meet.
inline scene::Scene bumpy() {
  scene::Scene s;
  s.cameras.push_back(runtime::test::camera_at({0, 1.2f, 4}, {0, 0.4f, 0}, 45, kSide, kSide));
  brdf::Callisto<double> velvet;
  velvet.diffuse_fresnel = 4, velvet.retroreflection = 3, velvet.dual_specular_opacity = 0.5;
  const scene::Index material = runtime::test::add_material(s, velvet);
  scene::Mesh mesh;
  constexpr int kRows = 133, kColumns = 266;
  for (int y = 0; y <= kRows; ++y)
    for (int x = 0; x <= kColumns; ++x) {
      const double theta = 3.14159265 * y / kRows, phi = 2 * 3.14159265 * x / kColumns;
      const double radius = 1 + 0.06 * std::sin(9 * theta) * std::sin(11 * phi);
      mesh.positions.emplace_back(radius * std::sin(theta) * std::cos(phi), 0.6 + radius * std::cos(theta),
                                  radius * std::sin(theta) * std::sin(phi));
    }
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const auto a = static_cast<scene::Index>(y * (kColumns + 1) + x), b = a + 1, c = a + kColumns + 1, d = c + 1;
      if (y > 0) mesh.triangles.push_back({a, b, d});
      if (y + 1 < kRows) mesh.triangles.push_back({a, d, c});
    }
  s.meshes.push_back(std::move(mesh));
  s.instances.push_back({"bumpy", 0, material, glm::mat4(1)});
  runtime::test::add_quad(s, material, {-4, -0.5f, 4}, {4, -0.5f, 4}, {4, -0.5f, -4}, {-4, -0.5f, -4});
  runtime::test::add_light(s, scene::PointLight{{2, 4, 3}, {40, 40, 40}});
  return s;
}

}  // namespace likeness::benchmark_scene
