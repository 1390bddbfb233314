#include "olat/render/from_scene.h"

#include <array>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "render/files/files.h"
#include "render/files/interrupt.h"
#include "render/plan/plan.h"
#include "render/reference/reference.h"
#include "render/runtime/pipeline.h"
#include "render/scene/read_scene.h"
#include "render/world/world.h"

namespace likeness::olat_render {

scene::Camera camera_of(const capture::Camera& camera) {
  const auto refuse = [&](const std::string& text) {
    throw files::UsageError("--scene: camera " + files::in_quotes(camera.id) + " " + text);
  };
  if (!camera.is_undistorted)
    refuse("has photographs with lens distortion; likeness olat calibrate CAPTURE --undistort --out NEW undoes it");
  if (camera.intrinsics[1][0] != 0)
    refuse("has a skew, and scenes have none; likeness olat calibrate CAPTURE --undistort --out NEW undoes it");
  scene::Camera out;
  out.name = camera.id;
  out.is_orthographic = camera.is_orthographic;
  out.width = camera.width;
  out.height = camera.height;
  out.focal_x = camera.intrinsics[0][0];
  out.focal_y = camera.intrinsics[1][1];
  out.center_x = camera.intrinsics[2][0];
  out.center_y = camera.intrinsics[2][1];
  // OpenCV looks along z with y down, a scene's camera along -z with y up.
  glm::dmat4 turned = camera.world_from_camera;
  turned[1] = -turned[1];
  turned[2] = -turned[2];
  out.world_from_camera = glm::mat4(turned);
  return out;
}

// The plane of an orthographic camera, which a capture puts anywhere, in front of all that the scene holds.
scene::Camera in_front_of(scene::Camera camera, const scene::Bounds& all) {
  if (!camera.is_orthographic || all.is_empty()) return camera;
  const glm::vec3 back(camera.world_from_camera[2]), position(camera.world_from_camera[3]);
  const float before = glm::dot(glm::max(back * all.low, back * all.high), glm::vec3(1)),
              room = 0.01f * glm::length(all.high - all.low) + 1e-6f;
  camera.world_from_camera[3] = glm::vec4(position + (before + room - glm::dot(position, back)) * back, 1);
  return camera;
}

scene::Light light_of(const capture::Light& light) {
  scene::Light out;
  out.name = light.id;
  if (const auto* distant = std::get_if<capture::DistantLight>(&light.place))
    out.shape = scene::DirectionalLight{-glm::vec3(distant->to_light), glm::vec3(1)};
  else if (const auto* near = std::get_if<capture::NearLight>(&light.place))
    out.shape = scene::PointLight{glm::vec3(near->position), glm::vec3(1)};
  else
    throw files::UsageError("--scene: light " + files::in_quotes(light.id) +
                            " has no place; give it a direction or a position in lights.json");
  return out;
}

image::Picture SceneRenderer::render(const capture::Capture& capture, std::size_t camera, std::size_t light,
                                     const std::function<bool(double)>& goes_on) const {
  scene::Scene scene = scene_;
  scene.cameras = {in_front_of(camera_of(capture.cameras[camera]), scene::bounds(scene_))};
  scene.lights = {light_of(capture.lights[light])};
  scene.environment.reset();
  for (scene::Material& material : scene.materials) {
    material.emission = glm::vec3(0);
    material.emission_map.reset();
  }
  const world::World world(scene, plan::plan_of(scene, 0));
  if (settings_.is_runtime) {
    runtime::Settings settings;
    settings.pixel_samples = static_cast<int>(settings_.samples);
    settings.seed = settings_.seed;
    return runtime::Pipeline(world).frame(0, settings, settings_.threads);
  }
  reference::Options options;
  options.samples = settings_.samples;
  options.seed = settings_.seed;
  options.max_bounces = settings_.max_bounces;
  options.threads = settings_.threads;
  reference::Film film(capture.cameras[camera].width, capture.cameras[camera].height, false);
  bool is_stopped = false;
  reference::render(world, options, film, [&](const reference::Progress& progress) {
    // Between tiles (share < 0) many threads ask at once: they only look whether to stop.
    if (progress.share < 0) return !files::interrupted();
    return goes_on(progress.share);
  });
  is_stopped = files::interrupted();
  if (is_stopped) throw files::Interrupted();
  return film.picture();
}

}  // namespace likeness::olat_render
