#include "render/capture/sight.h"

#include <algorithm>
#include <string>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/files/files.h"
#include "render/image/read.h"

namespace likeness::capture {

glm::dvec3 to_view_of(const Camera& camera, int x, int y) {
  const glm::dmat3 turn(camera.world_from_camera);
  if (camera.is_orthographic) return -turn[2];
  const glm::dvec3 way = glm::inverse(camera.intrinsics) * glm::dvec3(x + 0.5, y + 0.5, 1);
  return -glm::normalize(turn * way);
}

Positions::Positions(const Capture& capture, std::size_t camera, const char* asker) : camera_(capture.cameras[camera]) {
  if (std::none_of(capture.lights.begin(), capture.lights.end(), is_near)) return;
  const auto file = layer_file(capture, camera, Layer::kPosition);
  if (!file.empty()) {
    layer_ = image::read_picture(file);
    if (layer_.width != camera_.width || layer_.height != camera_.height)
      throw files::InputError(file.string() + ": has " + std::to_string(layer_.width) + " x " +
                              std::to_string(layer_.height) + " pixels; its camera " + files::in_quotes(camera_.id) +
                              " has " + std::to_string(camera_.width) + " x " + std::to_string(camera_.height));
  } else if (!camera_.is_orthographic) {
    throw files::UsageError(std::string(asker) +
                            ": near lights need to know where the surface is; add the layer position of camera " +
                            files::in_quotes(camera_.id) + " to cameras.json");
  }
}

glm::dvec3 Positions::at(int x, int y) const {
  if (layer_.width > 0) return {layer_.at(x, y)[0], layer_.at(x, y)[1], layer_.at(x, y)[2]};
  if (!camera_.is_orthographic) return glm::dvec3(0);
  const glm::dvec3 on_picture = glm::inverse(camera_.intrinsics) * glm::dvec3(x + 0.5, y + 0.5, 1);
  const glm::dmat3 turn(camera_.world_from_camera);
  const glm::dvec3 from = glm::dvec3(camera_.world_from_camera[3]) + turn * glm::dvec3(on_picture.x, on_picture.y, 0);
  return from - turn[2] * glm::dot(from, turn[2]);
}

Shine shine_of(const Light& light, const glm::dvec3& point) {
  if (const auto* distant = std::get_if<DistantLight>(&light.place)) return {distant->to_light, 1};
  const auto* near = std::get_if<NearLight>(&light.place);
  if (!near) return {};
  const glm::dvec3 way = near->position - point;
  const double distance = glm::length(way);
  if (!(distance > 1e-6)) return {};  // also where the point is NaN
  return {way / distance, 1 / (distance * distance)};
}

bool is_near(const Light& light) { return std::holds_alternative<NearLight>(light.place); }
bool has_place(const Light& light) { return !std::holds_alternative<std::monostate>(light.place); }

}  // namespace likeness::capture
