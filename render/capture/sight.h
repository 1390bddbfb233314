#pragma once

#include <cstddef>
#include <optional>

#include <glm/vec3.hpp>

#include "render/capture/capture.h"
#include "render/image/picture.h"

// Where a pixel of a capture looks, and how a light reaches the piece of surface that it sees.
namespace likeness::capture {

// Unit, from the surface that the middle of the pixel sees towards the camera, in the world.
glm::dvec3 to_view_of(const Camera& camera, int x, int y);

// Where the surface is, in the world [m]. Of the layer `position`; for an orthographic camera without it the plane
// through the world's origin that faces the camera; without pixels where no light is near, because then nobody asks.
class Positions {
 public:
  // Throws files::InputError for a layer of another size than the camera, and files::UsageError, which begins with `asker`,
  // for near lights in the picture of a camera that is not orthographic and has no such layer.
  Positions(const Capture& capture, std::size_t camera, const char* asker);
  glm::dvec3 at(int x, int y) const;

 private:
  const Camera& camera_;
  image::Picture layer_;
};

// What shines on a point.
struct Shine {
  glm::dvec3 to_light{0, 0, 1};  // unit
  double irradiance = 0;         // on a surface that faces it, of a light of intensity 1: 1, or 1 / d^2 [1/m^2] if near
};
// Of a light whose place is known. Irradiance is 0 where the point is the light's own.
Shine shine_of(const Light& light, const glm::dvec3& point);

bool is_near(const Light& light);
bool has_place(const Light& light);

}  // namespace likeness::capture
