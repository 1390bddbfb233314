#pragma once

#include <array>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "brdf/lighting/spherical_harmonics.h"
#include "render/light/environment.h"

namespace likeness::runtime {

// The environment as a frame reads it: harmonics of its irradiance, pictures of it as GGX lobes of some roughnesses blur
// it, and what a GGX lobe returns of white light. Shadows are not in it.
// Source  irradiance: Ramamoorthi and Hanrahan 2001; the rest: Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013
//         course (the lobe about the mirror direction as if it were seen head on, times the split-off reflectance).
class EnvironmentMaps {
 public:
  EnvironmentMaps() = default;
  explicit EnvironmentMaps(const light::Environment& environment);

  // Irradiance on a surface with this normal [W/m^2].
  glm::vec3 irradiance(const glm::vec3& normal) const;
  // Integral of the radiance over the hemisphere about it, without the cosine [W/m^2].
  glm::vec3 hemisphere(const glm::vec3& normal) const;
  // Radiance about a direction, blurred by the lobe of a roughness [W/(m^2 sr)].
  glm::vec3 radiance(const glm::vec3& direction, float roughness) const;
  // (a, b): a GGX lobe with Schlick's Fresnel returns f0 a + b of white light to a view.
  static glm::vec2 reflectance(float cos_o, float roughness);

 private:
  static constexpr int kWidth = 64, kHeight = 32;
  static constexpr std::array kRoughness{0.25f, 0.4f, 0.55f, 0.7f, 0.85f, 1.0f};

  const light::Environment* environment_ = nullptr;
  std::array<brdf::Sh<float>, 3> irradiance_, hemisphere_;
  std::array<std::vector<glm::vec3>, kRoughness.size()> blurred_;
};

}  // namespace likeness::runtime
