#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "render/ray/tracer.h"
#include "render/scene/scene.h"

namespace likeness::world {

// A camera that sends rays.
class Camera {
 public:
  explicit Camera(const scene::Camera& camera);

  int width() const { return width_; }
  int height() const { return height_; }

  // The ray through a point of the picture [pixel, (0, 0) is the top left corner], with a unit direction. `lens` in
  // [0, 1)^2 is a point of the lens; a pinhole does not read it.
  ray::Ray ray(const glm::vec2& at, const glm::vec2& lens = {0.5f, 0.5f}) const;

  // By how much a pinhole's ray moves aside at a distance [m] when the picture's point moves by one pixel, over that
  // distance: the change of its unit direction. Parallel rays move as far at any.
  struct Spread {
    glm::vec3 right, down;
  };
  Spread spread(const glm::vec3& direction, float distance) const;
  bool is_orthographic() const { return is_orthographic_; }

  // The unit direction from a point in the world to where the camera (of a thin lens, its middle) sees it from.
  glm::vec3 to_view(const glm::vec3& point) const;

  // The distance along the axis (its depth) of a point in the world [m], negative behind the camera.
  float depth(const glm::vec3& point) const;
  const glm::vec3& position() const { return position_; }
  bool has_lens() const { return lens_radius_ > 0; }
  // Width of a pixel at a distance of 1 m [m]; orthographic: at any.
  float pixel_size() const { return 1 / focal_y_; }

 private:
  int width_, height_;
  bool is_orthographic_;
  float focal_x_, focal_y_, center_x_, center_y_, lens_radius_, focus_distance_;
  glm::mat3 world_from_camera_;
  glm::vec3 position_;
};

}  // namespace likeness::world
