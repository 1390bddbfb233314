#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "render/capture/capture.h"
#include "render/capture/sight.h"

// What is known of a pixel before any photograph of it is looked at: from where it is seen and what shines on it.
namespace likeness::capture_fit {

struct Site {
  glm::dvec3 to_view{0, 0, 1};         // unit
  std::vector<capture::Shine> shines;  // of each light of the stack
};

// Sites of a camera. Those of lights that are all distant differ in the view alone.
class Sites {
 public:
  Sites(const capture::Capture& capture, std::size_t camera, const std::vector<std::size_t>& lights)
      : capture_(capture),
        camera_(capture.cameras[camera]),
        positions_(capture, camera, "likeness fit capture"),
        lights_(lights) {}

  // Writes into `site`, so that a loop over pixels allocates once.
  void at(std::uint32_t pixel, Site& site) const {
    const auto width = static_cast<std::uint32_t>(camera_.width);
    const int x = static_cast<int>(pixel % width), y = static_cast<int>(pixel / width);
    site.to_view = capture::to_view_of(camera_, x, y);
    const glm::dvec3 point = positions_.at(x, y);
    site.shines.resize(lights_.size());
    for (std::size_t k = 0; k < lights_.size(); ++k)
      site.shines[k] = capture::shine_of(capture_.lights[lights_[k]], point);
  }

 private:
  const capture::Capture& capture_;
  const capture::Camera& camera_;
  capture::Positions positions_;
  const std::vector<std::size_t>& lights_;
};

}  // namespace likeness::capture_fit
