#pragma once

#include <filesystem>
#include <functional>

#include "render/capture/capture.h"
#include "tests/olat/planted.h"

namespace likeness::olat_test {

// What the photos of a capture have that its renders have not. Nothing, as it stands.
struct Faults {
  std::function<void(std::size_t light, Ball& ball, Planted& planted)> plant;
  bool has_renders = true, has_normals = true, has_mask = true;
};

// The ball as a capture on disk: one camera "front", a ring of lights "000", "001", ... of which the directions are right,
// photos with the noise of a camera, and renders of the ball without faults as the variant "plain". Photos are EXR.
inline constexpr std::size_t kBallLights = 9;
capture::Capture write_ball_capture(const std::filesystem::path& folder, const Faults& faults = {});

Ball rendered_ball();

}  // namespace likeness::olat_test
