#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "render/files/files.h"
#include "render/scene/ies.h"
#include "render/scene/read_entries.h"

namespace likeness::scene {
namespace {

constexpr double kPi = std::numbers::pi;

// The direction in which a light shines: `direction`, or from its position to `target`.
glm::dvec3 heading(const Fields& fields, const glm::dvec3& position) {
  fields.only_one_of("direction", "target");
  if (!fields.has("target")) return fields.direction("direction");
  const glm::dvec3 way = fields.vector("target") - position;
  if (!(glm::length(way) > 1e-9)) fields.refuse("target", " is where the light stands; expected a point it shines at");
  return glm::normalize(way);
}

// The strength in watts: of `unit` W or W/..., or divided by 683 lm/W.
glm::dvec3 watts(const Fields& fields) {
  const std::string unit = fields.text("unit");
  const bool is_photometric = unit[0] != 'W' && unit != "profile";
  return fields.vector("strength") * fields.vector("color") / (is_photometric ? kLumensPerWatt : 1.0);
}

bool is_total(const Fields& fields) { return fields.text("unit") == "W" || fields.text("unit") == "lm"; }

// The intensity [W/sr] of a light without size. Its power is spread over `solid_angle` [sr]: the integral of what the
// intensity is multiplied by, over the sphere.
glm::vec3 intensity(const Fields& fields, const Profile* profile, double solid_angle) {
  const glm::dvec3 power = watts(fields);
  if (is_total(fields)) return power / solid_angle;
  if (fields.text("unit") != "profile") return power;
  if (!profile) fields.refuse("unit", " is profile, but there is no \"profile\"");
  return power * static_cast<double>(peak(*profile)) / kLumensPerWatt;
}

// The radiance [W/(m^2 sr)] of a Lambertian light of that area, all sides together: P / (pi A).
glm::vec3 radiance(const Fields& fields, double area) { return watts(fields) / (is_total(fields) ? kPi * area : 1.0); }

// The integral over the sphere of a spot's cone: 1 within the inner one, smoothstep of the cosine to the outer one, whose
// mean is one half: 2 pi (1 - (cos inner + cos outer) / 2).
double cone_solid_angle(double inner, double outer) {
  return 2 * kPi * (1 - 0.5 * (std::cos(inner) + std::cos(outer)));
}

void read_profile(const Fields& fields, const std::filesystem::path& folder, Loading& loading, Light& out) {
  if (!fields.has("profile")) return;
  out.profile = loading.profile(folder / fields.text("profile"));
  const glm::dvec3 axis = fields.direction("profile_axis"), zero = fields.direction("profile_zero");
  const glm::dvec3 square = zero - axis * glm::dot(axis, zero);
  if (!(glm::length(square) > 1e-6))
    fields.refuse("profile_zero", " is along profile_axis; expected a direction across it");
  out.profile_axis = axis;
  out.profile_zero = glm::normalize(square);
}

RectangleLight rectangle(const Fields& fields, const glm::dvec3& center) {
  RectangleLight out;
  glm::dvec3 u, v;
  if (fields.has("half_u") || fields.has("half_v")) {
    for (const char* key : {"size", "direction", "target", "up"}) fields.only_one_of(key, "half_u");
    if (!fields.has("half_u") || !fields.has("half_v"))
      fields.refuse(fields.has("half_u") ? "half_u" : "half_v", " stands alone; expected half_u and half_v");
    u = fields.vector("half_u");
    v = fields.vector("half_v");
    const double lengths = glm::length(u) * glm::length(v);
    if (!(lengths > 1e-12) || !(glm::length(glm::cross(u, v)) > 1e-6 * lengths))
      fields.refuse("half_u", " and half_v span no area; expected two edges");
    if (std::abs(glm::dot(u, v)) > 1e-4 * lengths)
      fields.refuse("half_u", " and half_v are not at right angles; expected a rectangle");
    v -= u * (glm::dot(u, v) / glm::dot(u, u));
  } else {
    // The camera that looks the way the light shines has the light's height upwards; seen from there u x v is ahead.
    const glm::dmat4 frame = look_along(center, heading(fields, center), fields.direction("up"));
    const glm::dvec2 size = fields.pair("size");
    u = -glm::dvec3(frame[0]) * (0.5 * size.x);
    v = glm::dvec3(frame[1]) * (0.5 * size.y);
  }
  out.center = center;
  out.half_u = u;
  out.half_v = v;
  out.two_sided = fields.flag("two_sided");
  out.radiance = radiance(fields, 4 * glm::length(u) * glm::length(v) * (out.two_sided ? 2 : 1));
  return out;
}

}  // namespace

Light light_of(const Fields& fields, const std::filesystem::path& folder, Loading& loading) {
  Light out;
  out.name = fields.text("name");
  out.is_movable = fields.flag("movable");
  const std::string_view type = fields.section().name;
  if (type == "directional") {
    out.shape = DirectionalLight{fields.direction("direction"), watts(fields)};
    return out;
  }
  const glm::dvec3 position = fields.vector("position");
  if (fields.has("range")) out.range = static_cast<float>(fields.number("range"));
  if (type == "point" || type == "spot") read_profile(fields, folder, loading, out);
  else out.is_visible = fields.flag("visible");
  const Profile* profile = out.profile == kNone ? nullptr : &loading.scene().profiles[out.profile];
  if (type == "point") {
    out.shape = PointLight{position, intensity(fields, profile, profile ? solid_angle(*profile) : 4 * kPi)};
  } else if (type == "spot") {
    const double inner = fields.number("inner_deg") * kPi / 180, outer = fields.number("outer_deg") * kPi / 180;
    if (inner > outer)
      fields.refuse("inner_deg", " = " + files::number_text(fields.number("inner_deg")) +
                                     " is beyond outer_deg = " + files::number_text(fields.number("outer_deg")));
    if (profile && is_total(fields))
      fields.refuse("unit", " is " + fields.text("unit") + " of a cone with a profile; state W/sr, cd or profile");
    out.shape =
        SpotLight{position, heading(fields, position), intensity(fields, profile, cone_solid_angle(inner, outer)),
                  static_cast<float>(inner), static_cast<float>(outer)};
  } else if (type == "rectangle") {
    out.shape = rectangle(fields, position);
  } else if (type == "disk") {
    const double radius = fields.number("radius");
    const bool is_two_sided = fields.flag("two_sided");
    out.shape = DiskLight{position, heading(fields, position), static_cast<float>(radius),
                          radiance(fields, kPi * radius * radius * (is_two_sided ? 2 : 1)), is_two_sided};
  } else {
    const double radius = fields.number("radius");
    out.shape = SphereLight{position, static_cast<float>(radius), radiance(fields, 4 * kPi * radius * radius)};
  }
  return out;
}

Environment environment_of(const Fields& fields, const std::filesystem::path& folder, Loading& loading) {
  fields.only_one_of("file", "radiance");
  fields.only_one_of("radiance", "scale");
  Environment out;
  const double unit = fields.text("unit") == "cd/m2" ? kLumensPerWatt : 1;
  if (fields.has("file")) {
    out.image = loading.image(folder / fields.text("file"), true);
    out.scale = fields.vector("scale") / unit;
  } else {
    out.scale = fields.vector("radiance") / unit;
  }
  out.turn = static_cast<float>(std::remainder(fields.number("turn_deg"), 360.0) * kPi / 180);
  return out;
}

}  // namespace likeness::scene
