#include "tests/realis/texture/mesh_capture.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "realis/texture/sight.h"
#include "render/capture/files_of_capture.h"
#include "render/capture/sight.h"
#include "render/image/write.h"
#include "render/ray/offset.h"
#include "render/scene/mesh_file.h"
#include "render/world/world.h"

namespace likeness::realis::test {
namespace {

capture::Camera camera_at(const std::string& id, const glm::dvec3& position, int size, const glm::dmat3& turn) {
  capture::Camera out;
  out.id = id, out.width = out.height = size;
  const double focal = 4.0 * size * glm::length(position);  // the object fills most of the picture
  out.intrinsics = glm::dmat3(focal, 0, 0, 0, focal, 0, 0.5 * size, 0.5 * size, 1);
  const glm::dvec3 forward = -glm::normalize(position);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0))), down = glm::cross(forward, right);
  out.world_from_camera = glm::dmat4(glm::dvec4(turn * right, 0), glm::dvec4(turn * down, 0),
                                     glm::dvec4(turn * forward, 0), glm::dvec4(turn * position, 1));
  return out;
}

image::Picture picture_of(const world::World& world, const capture::Camera& camera, const capture::Light& light,
                          double reflectance) {
  const Projection projection(camera);
  image::Picture out(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const ray::Ray ray = projection.ray(x, y);
      const ray::Hit hit = world.tracer.closest(ray);
      if (!hit.is_some()) continue;
      surface::Point point;
      world.surfaces.at<surface::Detail::kTextures>(ray, hit, point);
      const capture::Shine shine = capture::shine_of(light, glm::dvec3(point.position));
      const double cosine = glm::dot(glm::dvec3(point.shading_normal), shine.to_light);
      ray::Ray shadow;
      shadow.origin = ray::beside(point.position, point.normal), shadow.direction = glm::vec3(shine.to_light);
      if (capture::is_near(light)) shadow.far = static_cast<float>(1 / std::sqrt(shine.irradiance));
      if (!(cosine > 0) || glm::dot(point.normal, shadow.direction) <= 0 || world.tracer.occluded(shadow)) continue;
      for (int c = 0; c < 3; ++c)
        out.at(x, y)[static_cast<std::size_t>(c)] =
            static_cast<float>(reflectance / std::numbers::pi * cosine * shine.irradiance);
    }
  return out;
}

}  // namespace

MeshCapture make_mesh_capture(const std::filesystem::path& folder, const MeshCaptureOptions& options) {
  MeshCapture out;
  scene::Mesh mesh = scene::shape_mesh(options.shape, glm::dvec3(1), options.segments);
  mesh.name = "mesh";
  out.scene.meshes = {std::move(mesh)};
  scene::Material material;
  material.name = "lambert";
  brdf::Lambert<double> lambert;
  lambert.base_color = brdf::Rgb<double>(options.rendered, options.rendered, options.rendered);
  material.brdf = lambert;
  out.scene.materials = {material};
  const double scale = options.shape == "plane" ? 0.2 : 0.1;
  out.scene.instances = {{"object", 0, 0, glm::mat4(glm::mat3(options.turn * scale))}};
  out.scene.cameras.resize(1);

  capture::Capture& c = out.capture;
  c.root = folder, c.name = "mesh";
  for (std::size_t i = 0; i < options.cameras.size(); ++i)
    c.cameras.push_back(camera_at("c" + std::to_string(i), options.cameras[i], options.size, options.turn));
  for (std::size_t i = 0; i < options.lights.size(); ++i) {
    capture::Light light;
    light.id = "l" + std::to_string(i);
    if (options.is_near) light.place = capture::NearLight{options.turn * options.lights[i]};
    else light.place = capture::DistantLight{glm::normalize(options.turn * options.lights[i])};
    c.lights.push_back(light);
  }
  c.variants = {{"render", "renders/{camera}/{light}.exr"}};
  const world::World world(out.scene, plan::plan_of(out.scene, 0));
  for (std::size_t camera = 0; camera < c.cameras.size(); ++camera)
    for (std::size_t light = 0; light < c.lights.size(); ++light) {
      capture::Frame frame;
      frame.camera = camera, frame.light = light, frame.clip = std::numeric_limits<double>::infinity();
      frame.file = "photos/" + c.cameras[camera].id + "/" + c.lights[light].id + ".exr";
      image::Picture photo = picture_of(world, c.cameras[camera], c.lights[light], options.photographed);
      if (options.fault) options.fault(camera, light, photo);
      image::write_exr(folder / frame.file, photo);
      image::write_exr(capture::render_file(c, c.variants[0], camera, light),
                       picture_of(world, c.cameras[camera], c.lights[light], options.rendered));
      c.frames.push_back(frame);
    }
  capture::write_capture(c);
  return out;
}

}  // namespace likeness::realis::test
