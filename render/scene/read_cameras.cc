#include <cmath>
#include <numbers>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/files/files.h"
#include "render/scene/read_entries.h"

namespace likeness::scene {
namespace {

constexpr double kRadian = std::numbers::pi / 180;

}  // namespace

glm::dmat4 look_along(const glm::dvec3& position, const glm::dvec3& forward, const glm::dvec3& up) {
  glm::dvec3 right = glm::cross(forward, up);
  if (!(glm::length(right) > 1e-6 * glm::length(up))) right = glm::cross(forward, glm::dvec3(0, 0, -1));
  if (!(glm::length(right) > 1e-6)) right = glm::dvec3(1, 0, 0);
  right = glm::normalize(right);
  return {glm::dvec4(right, 0), glm::dvec4(glm::cross(right, forward), 0), glm::dvec4(-forward, 0),
          glm::dvec4(position, 1)};
}

Camera camera_of(const Fields& fields) {
  Camera out;
  out.name = fields.text("name");
  out.width = fields.whole("width");
  out.height = fields.whole("height");
  if (static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) > kMostPixels)
    fields.refuse("width", " times height is " + std::to_string(std::size_t(out.width) * std::size_t(out.height)) +
                               " pixels; expected at most " + std::to_string(kMostPixels));
  double focus = 1;
  if (fields.has("matrix")) {
    for (const char* key : {"position", "target", "up"}) fields.only_one_of(key, "matrix");
    out.world_from_camera = glm::mat4(fields.rigid("matrix"));
  } else {
    const glm::dvec3 position = fields.vector("position");
    glm::dvec3 way(0, 0, -1);
    if (fields.has("target")) {
      way = fields.vector("target") - position;
      focus = glm::length(way);
      if (!(focus > 1e-9)) fields.refuse("target", " is where the camera stands; expected a point it looks at");
    }
    out.world_from_camera = glm::mat4(look_along(position, glm::normalize(way), fields.direction("up")));
  }

  fields.only_one_of("fov_deg", "focal_mm");
  fields.only_one_of("fov_deg", "focal_px");
  fields.only_one_of("focal_mm", "focal_px");
  const double sensor = fields.number("sensor_mm");
  for (const char* key : {"fov_deg", "focal_mm", "focal_px", "aperture_radius", "f_number", "focus_distance"})
    fields.only_one_of(key, "orthographic_height");
  if (fields.has("orthographic_height")) {
    out.is_orthographic = true;
    out.focal_x = out.focal_y = out.height / fields.number("orthographic_height");
  } else if (fields.has("focal_px")) {
    out.focal_x = fields.pair("focal_px").x;
    out.focal_y = fields.pair("focal_px").y;
  } else {
    const double over_height = fields.has("focal_mm") ? fields.number("focal_mm") / sensor
                                                      : 0.5 / std::tan(0.5 * kRadian * fields.number("fov_deg"));
    out.focal_x = out.focal_y = over_height * out.height;
  }
  out.center_x = 0.5 * out.width;
  out.center_y = 0.5 * out.height;
  if (fields.has("center_px")) {
    out.center_x = fields.pair("center_px").x;
    out.center_y = fields.pair("center_px").y;
  }

  fields.only_one_of("aperture_radius", "f_number");
  if (fields.has("aperture_radius")) out.lens_radius = static_cast<float>(fields.number("aperture_radius"));
  if (fields.has("f_number"))
    out.lens_radius = static_cast<float>(out.focal_y / out.height * sensor * 1e-3 / (2 * fields.number("f_number")));
  out.focus_distance = static_cast<float>(fields.has("focus_distance") ? fields.number("focus_distance") : focus);
  return out;
}

View view_of(const Fields& fields, const std::filesystem::path& folder) {
  View out;
  out.ev = fields.number("ev");
  out.name = fields.text("name");
  out.display = fields.text("display");
  if (fields.has("config")) out.config = (folder / fields.text("config")).string();
  return out;
}

glm::dmat4 place_of(const Fields& fields) {
  glm::dmat4 out(1);
  std::string_view cause = "matrix";
  if (fields.has("matrix")) {
    for (const char* key : {"scale", "rotate_deg", "translate"}) fields.only_one_of(key, "matrix");
    out = fields.matrix("matrix");
  } else {
    cause = "scale";
    const glm::dvec3 turn = fields.vector("rotate_deg") * kRadian;
    out = glm::translate(out, fields.vector("translate"));
    out = glm::rotate(out, turn.z, glm::dvec3(0, 0, 1));
    out = glm::rotate(out, turn.y, glm::dvec3(0, 1, 0));
    out = glm::rotate(out, turn.x, glm::dvec3(1, 0, 0));
    out = glm::scale(out, fields.vector("scale"));
  }
  double lengths = 1;
  for (int c = 0; c < 3; ++c) {
    const double length = glm::length(glm::dvec3(out[c]));
    if (!(length > 1e-9))
      fields.refuse(cause, " makes the mesh flat (axis " + std::to_string(c) + "); it could not be undone");
    lengths *= length;
  }
  if (!(std::abs(glm::determinant(glm::dmat3(out))) > 1e-9 * lengths))
    fields.refuse(cause, " makes the mesh flat (determinant " + files::number_text(glm::determinant(glm::dmat3(out))) +
                             "); it could not be undone");
  return out;
}

}  // namespace likeness::scene
