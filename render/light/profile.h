#pragma once

#include <glm/vec3.hpp>

#include "render/scene/scene.h"

namespace likeness::light {

// Luminous intensity over its largest value, [0, 1], of a profile in a direction (unit, in world space, away from the
// light), for a light with its nadir along `axis` and its 0 degree plane towards `zero`. Linear between the angles that
// were measured; 0 outside of them.
// Source  IES LM-63-02: type C has its poles along the vertical, type B along the horizontal axis across 0 degrees.
float relative_intensity(const scene::Profile& profile, float largest, const glm::vec3& axis, const glm::vec3& zero,
                         const glm::vec3& direction);

float largest_candela(const scene::Profile& profile);

}  // namespace likeness::light
