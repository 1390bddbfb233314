#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "fit/capture/shared.h"

namespace likeness::capture_fit {
namespace {

constexpr int kMostRounds = 20;
constexpr double kSettled = 1e-3;  // of the scale: a relative change of the color that ends the rounds

brdf::Vec3<double> local(const glm::dvec3& v, const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& n) {
  return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, n)};
}

// keeps(k): whether the light counts; called for those that do in their order.
template <class Keeps>
void face_where(const Site& site, const glm::dvec3& normal, double exposure, Face& out, const Keeps& keeps) {
  out.angles.clear();
  out.shine.clear();
  out.light.clear();
  if (normal == glm::dvec3(0) || !(glm::dot(normal, site.to_view) > 0)) return;
  // No shared parameter reads the tangents, so any will do.
  const glm::dvec3 away = std::abs(normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(away, normal)), y = glm::cross(normal, x);
  const brdf::Vec3<double> view = local(site.to_view, x, y, normal);
  for (std::size_t k = 0; k < site.shines.size(); ++k) {
    const auto& [to_light, irradiance] = site.shines[k];
    if (!(irradiance > 0) || !(glm::dot(to_light, normal) > 0) || !keeps(k)) continue;
    out.angles.emplace_back(local(to_light, x, y, normal), view);
    out.shine.push_back(exposure * irradiance * out.angles.back().cos_i);
  }
}

}  // namespace

void face_of(const Site& site, const glm::dvec3& normal, const Stack& stack, std::size_t pixel, double exposure,
             double level, Face& out) {
  out.level = level;
  const auto r = stack.of(pixel, 0), g = stack.of(pixel, 1), b = stack.of(pixel, 2);
  const glm::dvec3 known = level > 0 ? normal : glm::dvec3(0);
  face_where(site, known, exposure, out, [&](std::size_t k) {
    if (!std::isfinite(r[k]) || !std::isfinite(g[k]) || !std::isfinite(b[k])) return false;
    out.light.push_back({static_cast<double>(r[k]), static_cast<double>(g[k]), static_cast<double>(b[k])});
    return true;
  });
}

void face_under(const Site& site, const glm::dvec3& normal, double exposure, Face& out) {
  face_where(site, normal, exposure, out, [](std::size_t) { return true; });
}

void shade(const brdf::Callisto<double>& material, const Face& face, FaceShading& out) {
  out.diffuse.resize(face.angles.size());
  out.specular.resize(face.angles.size());
  brdf::Callisto<double> m = material;
  m.base_color = {1, 0, 0};  // red: D + S; green: S
  with_parts(m.specular_fresnel_falloff == kGlossyFalloff, m.smooth_terminator != 0,
             m.diffuse_fresnel != 1 || m.retroreflection != 1, [&]<unsigned kParts>() {
               for (std::size_t k = 0; k < face.angles.size(); ++k) {
                 const auto f = m.eval<kParts>(face.angles[k]);
                 out.diffuse[k] = (f.r - f.g) * face.shine[k];
                 out.specular[k] = f.g * face.shine[k];
               }
             });
}

void color_of(const Face& face, const FaceShading& shading, double scale, Colored& out) {
  const std::size_t count = face.angles.size();
  out.weights.assign(count, 1);
  out.squares.assign(count, 0);
  out.color = {};
  out.is_known = false;
  out.weight = out.error = 0;
  double squares_of_d = 0;
  const auto solve = [&] {
    std::array<double, 3> sum{};
    squares_of_d = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double d = out.weights[k] * shading.diffuse[k];
      squares_of_d += d * shading.diffuse[k];
      for (std::size_t c = 0; c < 3; ++c) sum[c] += d * (face.light[k][c] - shading.specular[k]);
    }
    if (!(squares_of_d > 0)) return false;
    for (std::size_t c = 0; c < 3; ++c) sum[c] = std::max(sum[c] / squares_of_d, 0.0);
    const double moved =
        std::max({std::abs(sum[0] - out.color[0]), std::abs(sum[1] - out.color[1]), std::abs(sum[2] - out.color[2])});
    const bool is_still = moved <= kSettled * scale * std::max({sum[0], sum[1], sum[2]});
    out.color = sum;
    out.is_known = true;
    return !is_still;
  };
  const double per_channel = 1 / (3 * face.level * face.level);
  const auto measure = [&] {
    for (std::size_t k = 0; k < count; ++k) {
      double square = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double r = face.light[k][c] - out.color[c] * shading.diffuse[k] - shading.specular[k];
        square += r * r;
      }
      out.squares[k] = square * per_channel;
    }
  };
  // The start: the lower median of the colors that single samples ask for, which half of the samples may spoil.
  std::vector<std::pair<double, std::size_t>>& asked = out.asked;
  asked.clear();
  for (std::size_t k = 0; k < count; ++k) {
    const auto& p = face.light[k];
    if (shading.diffuse[k] > 0)
      asked.emplace_back((p[0] + p[1] + p[2] - 3 * shading.specular[k]) / shading.diffuse[k], k);
  }
  if (asked.empty()) return;
  const auto middle = asked.begin() + static_cast<std::ptrdiff_t>((asked.size() - 1) / 2);
  std::nth_element(asked.begin(), middle, asked.end());
  for (std::size_t c = 0; c < 3; ++c)
    out.color[c] = std::max(
        0.0, (face.light[middle->second][c] - shading.specular[middle->second]) / shading.diffuse[middle->second]);
  out.is_known = true;
  for (int round = 0; round < kMostRounds; ++round) {
    measure();
    for (std::size_t k = 0; k < count; ++k) out.weights[k] = 1 / (1 + out.squares[k] / (scale * scale));
    if (!solve()) break;
  }
  measure();
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k) {
    out.weights[k] = 1 / (1 + out.squares[k] / (scale * scale));
    out.weight += out.weights[k];
    sum += out.weights[k] * out.squares[k];
  }
  const double mean = (out.color[0] + out.color[1] + out.color[2]) / 3;
  const double variance = sum * face.level * face.level / std::max(out.weight - 1, 1.0);
  out.error = mean > 0 ? std::sqrt(variance / squares_of_d) / mean : 1;
}

}  // namespace likeness::capture_fit
