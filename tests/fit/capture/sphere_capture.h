#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "brdf/about_normal.h"
#include "brdf/callisto.h"
#include "fit/capture/capture_fit.h"
#include "render/capture/capture.h"
#include "render/image/picture.h"
#include "render/image/write.h"

// A sphere of one Callisto material in an orthographic picture, exact at the middle of each pixel: what a fit must find.
namespace likeness::test {

struct SphereCapture {
  int size = 40;
  brdf::Callisto<double> material{};  // base_color is replaced by color_at
  std::vector<glm::dvec3> lights{};
  bool has_near_lights = false;  // at those places
  bool with_normals = false;
  // Of a photo's pixel, after shading; the light's position in `lights`.
  std::function<void(std::size_t light, int x, int y, float* rgb)> spoil{};
};

// World: x right, y up, z to the camera; the sphere fills the picture.
inline glm::dvec3 sphere_normal(int size, int x, int y) {
  const double u = (x + 0.5) / size * 2 - 1, v = 1 - (y + 0.5) / size * 2, z = 1 - u * u - v * v;
  return z > 0.02 ? glm::normalize(glm::dvec3(u, v, std::sqrt(z))) : glm::dvec3(0);
}
inline brdf::Rgb<double> sphere_color(int size, int x, int y) {
  return {0.3 + 0.4 * x / size, 0.5 - 0.3 * y / size, 0.2 + 0.1 * std::sin(0.4 * x)};
}

// On a spiral about z, up to `reach_deg` away from it.
inline std::vector<glm::dvec3> spiral_of_lights(std::size_t count, double reach_deg = 60) {
  std::vector<glm::dvec3> out;
  const double least = std::cos(reach_deg * 3.14159265358979 / 180);
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (1 - least) * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double r = std::sqrt(1 - z * z), angle = 2.399963 * static_cast<double>(i);
    out.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return out;
}

inline brdf::Callisto<double> lambert_material() {
  brdf::Callisto<double> out;
  out.specular = 0;
  out.specular_fresnel_falloff = 0;
  return out;
}

// Photos, mask and, if asked for, normals are written below `root`; the capture is in memory alone.
inline capture::Capture make_sphere(const std::filesystem::path& root, const SphereCapture& want) {
  std::filesystem::create_directories(root);
  capture::Capture out;
  out.root = root;
  out.name = "sphere";
  capture::Camera camera;
  camera.id = "c";
  camera.width = camera.height = want.size;
  camera.is_orthographic = true;
  const double pixels_a_metre = want.size / 2.0;
  camera.intrinsics = {pixels_a_metre, 0, 0, 0, pixels_a_metre, 0, want.size / 2.0, want.size / 2.0, 1};
  camera.world_from_camera = glm::dmat4(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 5, 1);
  out.cameras.push_back(camera);
  image::Picture mask(want.size, want.size), normals(want.size, want.size);
  for (int y = 0; y < want.size; ++y)
    for (int x = 0; x < want.size; ++x) {
      const glm::dvec3 n = sphere_normal(want.size, x, y);
      for (int c = 0; c < 3; ++c) {
        mask.at(x, y)[static_cast<std::size_t>(c)] = n == glm::dvec3(0) ? 0.0f : 1.0f;
        normals.at(x, y)[static_cast<std::size_t>(c)] = static_cast<float>(n[c]);
      }
    }
  image::write_exr(root / "mask.exr", mask);
  out.layers.push_back({0, capture::Layer::kMask, "mask.exr"});
  if (want.with_normals) {
    image::write_exr(root / "normal.exr", normals);
    out.layers.push_back({0, capture::Layer::kNormal, "normal.exr"});
  }
  for (std::size_t l = 0; l < want.lights.size(); ++l) {
    capture::Light light;
    light.id = "l" + std::to_string(l);
    if (want.has_near_lights) light.place = capture::NearLight{want.lights[l]};
    else light.place = capture::DistantLight{glm::normalize(want.lights[l])};
    out.lights.push_back(light);
    image::Picture photo(want.size, want.size);
    for (int y = 0; y < want.size; ++y)
      for (int x = 0; x < want.size; ++x) {
        const glm::dvec3 n = sphere_normal(want.size, x, y);
        const auto rgb = photo.at(x, y);
        // Near lights shine on the plane through the origin, as a fit without positions takes it.
        const glm::dvec3 point((x + 0.5) / want.size * 2 - 1, 1 - (y + 0.5) / want.size * 2, 0);
        const glm::dvec3 way = want.has_near_lights ? want.lights[l] - point : glm::normalize(want.lights[l]);
        const double irradiance = 1 / glm::dot(way, way);
        const glm::dvec3 to = glm::normalize(way);
        const double cosine = glm::dot(n, to);
        if (n != glm::dvec3(0) && cosine > 0) {
          brdf::Callisto<double> material = want.material;
          material.base_color = sphere_color(want.size, x, y);
          const auto f = brdf::eval_about(material, {n.x, n.y, n.z}, {to.x, to.y, to.z}, {0, 0, 1});
          rgb[0] = static_cast<float>(f.r * cosine * irradiance);
          rgb[1] = static_cast<float>(f.g * cosine * irradiance);
          rgb[2] = static_cast<float>(f.b * cosine * irradiance);
        }
        if (want.spoil) want.spoil(l, x, y, rgb.data());
      }
    image::write_exr(root / (light.id + ".exr"), photo);
    capture::Frame frame;
    frame.light = l;
    frame.file = light.id + ".exr";
    frame.clip = INFINITY;
    out.frames.push_back(frame);
  }
  return out;
}

}  // namespace likeness::test

namespace likeness::capture_fit {

inline const GoesOn kGo = [](double, std::string_view) { return true; };
inline const Options kEstimate{.normals = NormalSource::kEstimate, .pixels = 300};

}  // namespace likeness::capture_fit
