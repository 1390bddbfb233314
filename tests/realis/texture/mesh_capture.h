#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "render/capture/capture.h"
#include "render/image/picture.h"
#include "render/scene/scene.h"

// Captures of a Lambert mesh of which all is known: direct light, exact shadows, one look through the middle of a pixel.
namespace likeness::realis::test {

struct MeshCaptureOptions {
  std::string shape = "plane";  // scene::shape_mesh; a plane of 0.2 m that faces +y, or a sphere of radius 0.1 m
  int segments = 48;
  int size = 96;                                  // of the pictures [pixel]
  std::vector<glm::dvec3> cameras{{0, 1, 0.01}};  // where they stand; they look at the origin
  std::vector<glm::dvec3> lights;                 // unit, or where near ones are
  bool is_near = false;
  double rendered = 0.5, photographed = 0.7;  // reflectance
  glm::dmat3 turn{1};                         // of everything
  // What is wrong with a photograph.
  std::function<void(std::size_t camera, std::size_t light, image::Picture&)> fault{};
};

struct MeshCapture {
  capture::Capture capture;
  scene::Scene scene;  // as it is rendered; one instance, "object"
};

MeshCapture make_mesh_capture(const std::filesystem::path& folder, const MeshCaptureOptions& options);

}  // namespace likeness::realis::test
