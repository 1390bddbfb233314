#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "render/reference/reference.h"

// Scenes of a few shapes, and ways to render them.
namespace likeness::reference {

inline scene::Camera camera_at(const glm::vec3& from, const glm::vec3& to, int width = 8, int height = 8,
                               double focal_per_width = 1) {
  scene::Camera camera;
  const glm::vec3 up = std::abs(glm::normalize(to - from).y) > 0.99f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  camera.world_from_camera = glm::inverse(glm::lookAt(from, to, up));
  camera.width = width, camera.height = height;
  camera.focal_x = camera.focal_y = focal_per_width * width;
  camera.center_x = 0.5 * width, camera.center_y = 0.5 * height;
  return camera;
}

inline scene::Mesh sphere_mesh() {
  scene::Mesh mesh;
  mesh.is_sphere = true;
  return mesh;
}
// A square of side 2 in the plane y = 0, facing up, with uvs.
inline scene::Mesh square_mesh() {
  scene::Mesh mesh;
  mesh.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}
// The cube [-1, 1]^3; its corners are in an order that faces out.
inline scene::Mesh box_mesh() {
  scene::Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}
inline scene::Material material_of(const brdf::AnyBrdf& brdf) {
  scene::Material material;
  material.brdf = brdf;
  return material;
}
inline brdf::Lambert<double> lambert(double albedo) {
  brdf::Lambert<double> model;
  model.base_color = brdf::Rgb<double>(albedo);
  return model;
}
inline glm::mat4 placed(const glm::vec3& at, float scale = 1) {
  return glm::scale(glm::translate(glm::mat4(1), at), glm::vec3(scale));
}

struct Rendered {
  image::Picture picture;
  Film film;
  glm::dvec3 mean{0};  // of all pixels
};
inline Rendered rendered(const scene::Scene& scene, Options options, bool force_all = false) {
  const world::World world(scene, plan::plan_of(scene, options.camera, force_all));
  const scene::Camera& camera = scene.cameras[options.camera];
  Rendered out{{}, Film(camera.width, camera.height, options.has_layers), {}};
  render(world, options, out.film, [](const Progress&) { return true; });
  out.picture = out.film.picture();
  for (std::size_t i = 0; i < out.picture.rgb.size(); ++i)
    out.mean[static_cast<int>(i % 3)] +=
        static_cast<double>(out.picture.rgb[i]) * 3 / static_cast<double>(out.picture.rgb.size());
  return out;
}

// The mean of the picture over seeds, and the error of that mean.
struct Estimate {
  double mean = 0, error = 0;
};
inline Estimate estimate(const scene::Scene& scene, Options options, int seeds = 12) {
  double sum = 0, squares = 0;
  for (int s = 0; s < seeds; ++s) {
    options.seed = 1000 + static_cast<std::uint32_t>(s);
    const double x = rendered(scene, options).mean.g;
    sum += x, squares += x * x;
  }
  const double mean = sum / seeds;
  return {mean, std::sqrt(std::max(squares / seeds - mean * mean, 0.0) / (seeds - 1))};
}

}  // namespace likeness::reference
