#include "render/light/profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <glm/geometric.hpp>

namespace likeness::light {
namespace {

constexpr float kDegrees = static_cast<float>(180 / std::numbers::pi);

// Where x lies among ascending angles: between `index` and the next, at `t` of the way. False: it is outside.
struct Place {
  std::size_t index = 0, next = 0;
  float t = 0;
};
bool place_of(std::span<const float> angles, float x, Place& place) {
  constexpr float kSlack = 1e-3f;  // [deg] that rounding may lead outside
  if (angles.size() == 1) return place = {}, true;
  if (x < angles.front() - kSlack || x > angles.back() + kSlack) return false;
  const auto after = std::upper_bound(angles.begin() + 1, angles.end() - 1, x);
  place.next = static_cast<std::size_t>(after - angles.begin());
  place.index = place.next - 1;
  const float width = angles[place.next] - angles[place.index];
  place.t = width > 0 ? std::clamp((x - angles[place.index]) / width, 0.0f, 1.0f) : 0.0f;
  return true;
}

}  // namespace

float largest_candela(const scene::Profile& profile) {
  float largest = 0;
  for (const float c : profile.candela) largest = std::max(largest, c);
  return largest;
}

float relative_intensity(const scene::Profile& profile, float largest, const glm::vec3& axis, const glm::vec3& zero,
                         const glm::vec3& direction) {
  if (!(largest > 0)) return 0;
  const float down = std::clamp(glm::dot(direction, axis), -1.0f, 1.0f);
  const float ahead = glm::dot(direction, zero), aside = glm::dot(direction, glm::cross(zero, axis));
  float vertical, horizontal;
  if (profile.type == scene::Profile::Type::kC) {
    vertical = std::acos(down) * kDegrees;
    horizontal = std::atan2(aside, ahead) * kDegrees;
    if (horizontal < 0) horizontal += 360;
  } else {
    // Type B: the vertical angle is the elevation out of the plane of `zero` and the axis' normal.
    horizontal = std::asin(std::clamp(aside, -1.0f, 1.0f)) * kDegrees;
    vertical = std::atan2(ahead, down) * kDegrees;
  }
  Place h, v;
  if (profile.horizontal_deg.size() > 1) {
    // Planes that are left out repeat those that are there: a half, or a quarter, that is mirrored.
    const float last = profile.horizontal_deg.back(), first = profile.horizontal_deg.front();
    if (profile.type == scene::Profile::Type::kC) {
      if (last <= 180 && horizontal > 180) horizontal = 360 - horizontal;
      if (last <= 90 && horizontal > 90) horizontal = 180 - horizontal;
    } else if (first >= 0) {
      horizontal = std::abs(horizontal);
    }
  }
  if (profile.type == scene::Profile::Type::kB && profile.vertical_deg.front() >= 0) vertical = std::abs(vertical);
  if (!place_of(profile.horizontal_deg, horizontal, h) || !place_of(profile.vertical_deg, vertical, v)) return 0;
  const std::size_t row = profile.vertical_deg.size();
  const auto at = [&](std::size_t i, std::size_t j) { return profile.candela[i * row + j]; };
  const float low = at(h.index, v.index) + v.t * (at(h.index, v.next) - at(h.index, v.index));
  const float high = at(h.next, v.index) + v.t * (at(h.next, v.next) - at(h.next, v.index));
  return std::max(low + h.t * (high - low), 0.0f) / largest;
}

}  // namespace likeness::light
