#include "render/world/camera.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "brdf/warp.h"

namespace likeness::world {

Camera::Camera(const scene::Camera& c)
    : width_(c.width),
      height_(c.height),
      is_orthographic_(c.is_orthographic),
      focal_x_(static_cast<float>(c.focal_x)),
      focal_y_(static_cast<float>(c.focal_y)),
      center_x_(static_cast<float>(c.center_x)),
      center_y_(static_cast<float>(c.center_y)),
      lens_radius_(c.is_orthographic ? 0 : c.lens_radius),
      focus_distance_(c.focus_distance),
      world_from_camera_(c.world_from_camera),
      position_(c.world_from_camera[3]) {}

ray::Ray Camera::ray(const glm::vec2& at, const glm::vec2& lens) const {
  const glm::vec3 way{(at.x - center_x_) / focal_x_, (center_y_ - at.y) / focal_y_, -1};
  if (is_orthographic_)
    return {position_ + world_from_camera_ * glm::vec3(way.x, way.y, 0), 0, -world_from_camera_[2], ray::kFar};
  if (lens_radius_ == 0) return {position_, 0, glm::normalize(world_from_camera_ * way), ray::kFar};
  const auto disk = brdf::cosine_hemisphere(lens.x, lens.y);
  const glm::vec3 on_lens{lens_radius_ * disk.x, lens_radius_ * disk.y, 0};
  return {position_ + world_from_camera_ * on_lens, 0,
          glm::normalize(world_from_camera_ * (way * focus_distance_ - on_lens)), ray::kFar};
}

Camera::Spread Camera::spread(const glm::vec3& direction, float distance) const {
  if (is_orthographic_)
    return {world_from_camera_[0] / (focal_x_ * distance), -world_from_camera_[1] / (focal_y_ * distance)};
  // direction = way / |way|, whose part along the axis is 1 / |way|.
  const float shortening = std::abs(glm::dot(direction, world_from_camera_[2]));
  const auto turn = [&](const glm::vec3& step) { return shortening * (step - glm::dot(step, direction) * direction); };
  return {turn(world_from_camera_[0] / focal_x_), turn(-world_from_camera_[1] / focal_y_)};
}

glm::vec3 Camera::to_view(const glm::vec3& point) const {
  return is_orthographic_ ? world_from_camera_[2] : glm::normalize(position_ - point);
}

float Camera::depth(const glm::vec3& point) const { return -glm::dot(point - position_, world_from_camera_[2]); }

}  // namespace likeness::world
