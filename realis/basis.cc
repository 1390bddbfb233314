#include "realis/basis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/geometric.hpp>

#include "brdf/lighting/spherical_gaussian.h"

namespace likeness::realis {

std::vector<double> values(std::span<const Lobe> lobes, std::span<const glm::dvec3> directions) {
  std::vector<double> out;
  out.reserve(lobes.size() * directions.size());
  for (const glm::dvec3& direction : directions)
    for (const Lobe& lobe : lobes) {
      brdf::WindowedGaussian<double> gaussian;
      gaussian.plain.axis = brdf::Vec3<double>(lobe.axis.x, lobe.axis.y, lobe.axis.z);
      gaussian.plain.sharpness = lobe.sharpness;
      out.push_back(gaussian.eval(brdf::Vec3<double>(direction.x, direction.y, direction.z)));
    }
  return out;
}

std::vector<double> values(const Basis& basis, std::span<const glm::dvec3> directions) {
  const std::vector<double> rows = values(basis.lobes, directions);
  if (basis.mix.empty()) return rows;
  const std::size_t lobes = basis.lobes.size(), mixes = basis.size();
  std::vector<double> out(mixes * directions.size());
  for (std::size_t i = 0; i < directions.size(); ++i)
    for (std::size_t m = 0; m < mixes; ++m)
      out[i * mixes + m] = std::inner_product(rows.begin() + static_cast<std::ptrdiff_t>(i * lobes),
                                              rows.begin() + static_cast<std::ptrdiff_t>((i + 1) * lobes),
                                              basis.mix.begin() + static_cast<std::ptrdiff_t>(m * lobes), 0.0);
  return out;
}

std::vector<glm::dvec3> spread_out(std::span<const glm::dvec3> directions, std::size_t count) {
  constexpr double kSame = 1e-12;  // 1 - cos of what counts as one direction
  constexpr int kMostRounds = 100;
  std::vector<glm::dvec3> different;
  for (const glm::dvec3& d : directions)
    if (std::none_of(different.begin(), different.end(),
                     [&](const glm::dvec3& other) { return glm::dot(d - other, d - other) < 2 * kSame; }))
      different.push_back(d);
  if (count >= different.size()) return different;
  if (count == 0) return {};

  // The first is the one nearest to the middle of all.
  glm::dvec3 middle(0);
  for (const glm::dvec3& d : different) middle += d;
  std::vector<glm::dvec3> centers;
  std::vector<double> nearest(different.size(), -std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  for (std::size_t i = 1; i < different.size(); ++i)
    if (glm::dot(different[i], middle) > glm::dot(different[next], middle)) next = i;
  while (centers.size() < count) {
    centers.push_back(different[next]);
    for (std::size_t i = 0; i < different.size(); ++i)
      nearest[i] = std::max(nearest[i], glm::dot(different[i], centers.back()));
    next = static_cast<std::size_t>(std::min_element(nearest.begin(), nearest.end()) - nearest.begin());
  }

  std::vector<std::size_t> of(different.size(), count);
  for (int round = 0; round < kMostRounds; ++round) {
    bool moved = false;
    std::vector<glm::dvec3> sums(count, glm::dvec3(0));
    for (std::size_t i = 0; i < different.size(); ++i) {
      std::size_t best = 0;
      for (std::size_t k = 1; k < count; ++k)
        if (glm::dot(different[i], centers[k]) > glm::dot(different[i], centers[best])) best = k;
      if (of[i] != best) of[i] = best, moved = true;
      sums[best] += different[i];
    }
    if (!moved) break;
    for (std::size_t k = 0; k < count; ++k)
      if (const double length = glm::length(sums[k]); length > 1e-9) centers[k] = sums[k] / length;
  }
  return centers;
}

}  // namespace likeness::realis
