#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "render/capture/capture.h"
#include "render/image/picture.h"
#include "render/scene/scene.h"

// Renders of a scene as a capture saw it: the scene's meshes and materials, the capture's camera and one of its lights.
// Lights, environment and cameras of the scene itself are left out; surfaces that emit are kept dark.
namespace likeness::olat_render {

struct SceneSettings {
  bool is_runtime = false;  // the run-time pipeline, or else the path tracer
  std::uint32_t samples = 64;
  std::uint32_t seed = 0;
  int max_bounces = 64;
  int threads = 0;
};

// The scene's camera and light of a pair: a distant light has an irradiance of 1 on a surface that faces it, a near one
// 1 W/sr, so that the picture is in the unit of photographs that were divided by the light's intensity. The plane of an
// orthographic camera is put in front of the scene when it is rendered. Throws files::UsageError for a light without a place and for a camera with distortion in its
// photographs.
scene::Camera camera_of(const capture::Camera& camera);
scene::Light light_of(const capture::Light& light);

class SceneRenderer {
 public:
  SceneRenderer(const scene::Scene& scene, const SceneSettings& settings) : scene_(scene), settings_(settings) {}

  // `goes_on` is asked within the picture with the share of it that is done; throws files::Interrupted if it says no.
  image::Picture render(const capture::Capture& capture, std::size_t camera, std::size_t light,
                        const std::function<bool(double)>& goes_on) const;

 private:
  const scene::Scene& scene_;
  SceneSettings settings_;
};

}  // namespace likeness::olat_render
