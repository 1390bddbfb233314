#include "render/runtime/environment_maps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "brdf/ggx.h"
#include "render/sampling/sobol.h"

namespace likeness::runtime {
namespace {

using std::numbers::pi_v;
constexpr int kSourceWidth = 128, kSourceHeight = 64;  // of the picture that is blurred

// Reflectance of a white GGX lobe over the view's cosine and roughness, both at the middle of 32 steps.
constexpr int kSteps = 32;
using Table = std::array<glm::vec2, kSteps * kSteps>;
Table reflectance_table() {
  constexpr std::uint32_t kSamples = 256;
  Table table;
  for (int j = 0; j < kSteps; ++j)
    for (int i = 0; i < kSteps; ++i) {
      const float cosine = (static_cast<float>(i) + 0.5f) / kSteps;
      const brdf::Vec3<float> view(std::sqrt(1 - cosine * cosine), 0, cosine);
      brdf::Ggx<float> white, black;
      white.f0 = brdf::Rgb<float>(1.0f), black.f0 = brdf::Rgb<float>(0.0f);
      white.roughness = black.roughness = (static_cast<float>(j) + 0.5f) / kSteps;
      float whole = 0, rise = 0;
      for (std::uint32_t s = 0; s < kSamples; ++s) {
        const glm::vec2 u = sampling::Samples(0, s, 0).next();
        whole += white.sample(view, 0, u.x, u.y).weight.r;
        rise += black.sample(view, 0, u.x, u.y).weight.r;
      }
      table[static_cast<std::size_t>(j * kSteps + i)] = glm::vec2(whole - rise, rise) / static_cast<float>(kSamples);
    }
  return table;
}

// Bilinear in a grid of values at the middles of its cells; u wraps or is clamped, v is clamped.
template <class T>
T between(const T* grid, int width, int height, float u, float v, bool wraps) {
  const float x = u * static_cast<float>(width) - 0.5f, y = v * static_cast<float>(height) - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const auto column = [&](int i) { return wraps ? (i + width) % width : std::clamp(i, 0, width - 1); };
  const int x0 = column(static_cast<int>(left)), x1 = column(static_cast<int>(left) + 1);
  const int y0 = std::clamp(static_cast<int>(top), 0, height - 1),
            y1 = std::clamp(static_cast<int>(top) + 1, 0, height - 1);
  return glm::mix(glm::mix(grid[y0 * width + x0], grid[y0 * width + x1], x - left),
                  glm::mix(grid[y1 * width + x0], grid[y1 * width + x1], x - left), y - top);
}

glm::vec3 at(const std::array<brdf::Sh<float>, 3>& channels, const glm::vec3& normal) {
  const brdf::Vec3<float> n(normal);
  // Bands above the second are left out: a light that is small and strong makes the sum negative on its far side.
  return glm::max(glm::vec3(channels[0].eval(n), channels[1].eval(n), channels[2].eval(n)), glm::vec3(0));
}

}  // namespace

EnvironmentMaps::EnvironmentMaps(const light::Environment& environment) : environment_(&environment) {
  // The picture as coarse cells, each the mean of some points, with its direction and solid angle.
  struct Source {
    glm::vec3 direction, radiance;
    float solid_angle;
  };
  std::vector<Source> sources(static_cast<std::size_t>(kSourceWidth * kSourceHeight));
  constexpr int kPoints = 8;
  tbb::parallel_for(0, kSourceHeight, [&](int y) {
    for (int x = 0; x < kSourceWidth; ++x) {
      glm::vec3 sum(0);
      for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i)
          sum += environment.radiance(environment.direction_at(
              {(static_cast<float>(x) + (static_cast<float>(i) + 0.5f) / kPoints) / kSourceWidth,
               (static_cast<float>(y) + (static_cast<float>(j) + 0.5f) / kPoints) / kSourceHeight}));
      const float top = pi_v<float> * static_cast<float>(y) / kSourceHeight,
                  bottom = pi_v<float> * static_cast<float>(y + 1) / kSourceHeight;
      sources[static_cast<std::size_t>(y * kSourceWidth + x)] = {
          environment.direction_at(
              {(static_cast<float>(x) + 0.5f) / kSourceWidth, (static_cast<float>(y) + 0.5f) / kSourceHeight}),
          sum / static_cast<float>(kPoints * kPoints),
          (std::cos(top) - std::cos(bottom)) * 2 * pi_v<float> / kSourceWidth};
    }
  });
  for (const Source& s : sources) {
    const brdf::Vec3<float> d(s.direction);
    for (std::size_t k = 0; k < 3; ++k) irradiance_[k].add(d, s.radiance[static_cast<int>(k)] * s.solid_angle);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    // Half the sphere by bands: 2 pi, pi, 0.
    for (std::size_t i = 0; i < 4; ++i)
      hemisphere_[k].c[i] = irradiance_[k].c[i] * pi_v<float> * (i == 0 ? 2.0f : 1.0f);
    irradiance_[k] = irradiance_[k].convolved_with_cosine();
  }

  for (std::size_t level = 0; level < kRoughness.size(); ++level) {
    const float alpha = brdf::alpha_of_roughness(kRoughness[level]);
    blurred_[level].resize(static_cast<std::size_t>(kWidth * kHeight));
    tbb::parallel_for(0, kHeight, [&](int y) {
      for (int x = 0; x < kWidth; ++x) {
        const glm::vec3 axis = environment.direction_at(
            {(static_cast<float>(x) + 0.5f) / kWidth, (static_cast<float>(y) + 0.5f) / kHeight});
        glm::vec3 sum(0);
        float weights = 0;
        for (const Source& s : sources) {
          const float cosine = glm::dot(s.direction, axis);
          if (cosine <= 0) continue;
          // Seen along the normal the half vector is half way: cos^2 = (1 + cos) / 2. What is proposed by D is weighted by
          // the light's cosine, and stands for 1 / (4 cos_h) of its solid angle.
          const float cos2_h = 0.5f * (1 + cosine), cos_h = std::sqrt(cos2_h);
          const float weight =
              brdf::ggx_distribution(alpha, cos_h, 0.5f * (1 - cosine)) * cosine / (4 * cos_h) * cos_h * s.solid_angle;
          sum += weight * s.radiance, weights += weight;
        }
        blurred_[level][static_cast<std::size_t>(y * kWidth + x)] = sum / weights;
      }
    });
  }
}

glm::vec3 EnvironmentMaps::irradiance(const glm::vec3& normal) const { return at(irradiance_, normal); }
glm::vec3 EnvironmentMaps::hemisphere(const glm::vec3& normal) const { return at(hemisphere_, normal); }

glm::vec3 EnvironmentMaps::radiance(const glm::vec3& direction, float roughness) const {
  const glm::vec2 place = environment_->place_of(direction);
  const auto level = [&](std::size_t i) {
    return between(blurred_[i].data(), kWidth, kHeight, place.x, place.y, true);
  };
  if (roughness < kRoughness[0])
    return glm::mix(environment_->radiance(direction), level(0), roughness / kRoughness[0]);
  std::size_t i = 0;
  while (i + 2 < kRoughness.size() && roughness > kRoughness[i + 1]) ++i;
  const float t = (roughness - kRoughness[i]) / (kRoughness[i + 1] - kRoughness[i]);
  return glm::mix(level(i), level(i + 1), std::clamp(t, 0.0f, 1.0f));
}

glm::vec2 EnvironmentMaps::reflectance(float cos_o, float roughness) {
  static const Table kTable = reflectance_table();
  return between(kTable.data(), kSteps, kSteps, cos_o, roughness, false);
}

}  // namespace likeness::runtime
