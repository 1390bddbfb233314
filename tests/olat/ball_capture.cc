#include "tests/olat/ball_capture.h"

#include <cstdio>
#include <string>

#include "render/capture/files_of_capture.h"
#include "render/image/write.h"

namespace likeness::olat_test {

Ball rendered_ball() {
  Ball ball;
  ball.size = 96, ball.radius = 40;
  return ball;
}

capture::Capture write_ball_capture(const std::filesystem::path& folder, const Faults& faults) {
  capture::Capture capture;
  capture.root = folder;
  capture.name = "ball";
  const Ball still = rendered_ball();
  capture::Camera camera;
  camera.id = "front";
  camera.width = camera.height = still.size;
  camera.intrinsics = glm::dmat3(100, 0, 0, 0, 100, 0, 48, 48, 1);
  camera.world_from_camera = glm::dmat4(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 3, 1);
  capture.cameras = {camera};
  const auto directions = ring_of_lights(kBallLights);
  for (std::size_t light = 0; light < kBallLights; ++light) {
    char id[8];
    std::snprintf(id, sizeof id, "%03zu", light);
    const auto& d = directions[light];
    capture.lights.push_back({id, "", capture::DistantLight{{d[0], d[1], d[2]}}, {1, 1, 1}, "planted"});
    Ball ball = still;
    Planted planted{.read_noise = 1e-3, .shot_noise = 1e-4, .seed = 40 + static_cast<unsigned>(light)};
    if (faults.plant) faults.plant(light, ball, planted);
    capture::Frame& frame = capture.frames.emplace_back();
    frame.light = light;
    frame.file = "photos/front/" + std::string(id) + ".exr";
    image::write_exr(folder / frame.file, ball_under(ball, d, planted));
    if (faults.has_renders)
      image::write_exr(folder / "renders/plain/front" / (std::string(id) + ".exr"), ball_under(still, d));
  }
  if (faults.has_mask) {
    Ball photographed = still;
    Planted ignored;
    if (faults.plant) faults.plant(0, photographed, ignored);
    const std::vector<float> inside = ball_mask(photographed);
    image::Picture mask(still.size, still.size);
    for (std::size_t i = 0; i < inside.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) mask.rgb[3 * i + c] = inside[i];
    image::write_exr(folder / "aux/mask.exr", mask);
    capture.layers.push_back({0, capture::Layer::kMask, "aux/mask.exr"});
  }
  if (faults.has_normals) {
    image::write_exr(folder / "aux/normal.exr", ball_normals(still));
    capture.layers.push_back({0, capture::Layer::kNormal, "aux/normal.exr"});
  }
  if (faults.has_renders) capture.variants = {{"plain", "renders/{variant}/{camera}/{light}.exr"}};
  capture::write_capture(capture);
  // Files of one second are not told apart by every file system: the renders are newer by a minute.
  const auto later = std::filesystem::last_write_time(folder / "capture.json") + std::chrono::minutes(1);
  if (faults.has_renders)
    for (const auto& entry : std::filesystem::directory_iterator(folder / "renders/plain/front"))
      std::filesystem::last_write_time(entry.path(), later);
  return capture;
}

}  // namespace likeness::olat_test
