#include "realis/export/terms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace likeness::realis {
namespace {

using std::numbers::pi;

std::vector<double> polynomials(const glm::dvec3& d) { return {1, d.x, d.y, d.x * d.x, d.x * d.y, d.y * d.y}; }

constexpr double kLeastElevation = 0.15;  // [rad], of the reader

std::vector<double> harmonics(const glm::dvec3& d) {
  const double phi = std::atan2(d.y, d.x);
  const double c = std::cos(std::min(std::acos(std::clamp(d.z, -1.0, 1.0)), pi / 2 - kLeastElevation));
  const double slope = std::sqrt(c - c * c);
  return {1 / std::sqrt(2 * pi),
          std::sqrt(6 / pi) * std::cos(phi) * slope,
          std::sqrt(3 / (2 * pi)) * (2 * c - 1),
          std::sqrt(6 / pi) * std::sin(phi) * slope,
          std::sqrt(30 / pi) * std::cos(2 * phi) * (c * c - c),
          std::sqrt(30 / pi) * std::cos(phi) * (2 * c - 1) * slope,
          std::sqrt(5 / (2 * pi)) * (1 - 6 * c + 6 * c * c),
          std::sqrt(30 / pi) * std::sin(phi) * (2 * c - 1) * slope,
          std::sqrt(30 / pi) * std::sin(2 * phi) * (c * c - c)};
}

// The hemisphere as the square |x| + |y| <= 1 of an octahedron, turned by 45 degrees; four corners of a cell are blended.
std::vector<double> grid(const glm::dvec3& d) {
  std::vector<double> out(kGrid * kGrid, 0.0);
  const double sum = std::abs(d.x) + std::abs(d.y) + std::abs(d.z), last = kGrid - 1;
  const double u = ((d.x + d.y) / sum + 1) / 2 * last, v = ((d.y - d.x) / sum + 1) / 2 * last;
  const double x = std::clamp(std::floor(u), 0.0, last - 1), y = std::clamp(std::floor(v), 0.0, last - 1);
  const std::size_t at = static_cast<std::size_t>(x) + kGrid * static_cast<std::size_t>(y);
  out[at] = (1 - (u - x)) * (1 - (v - y));
  out[at + 1] = (u - x) * (1 - (v - y));
  out[at + kGrid] = (1 - (u - x)) * (v - y);
  out[at + kGrid + 1] = (u - x) * (v - y);
  return out;
}

constexpr double kLeastWeight = 0.001;  // what counts for less the reader drops

std::vector<double> gaussians(const glm::dvec3& d) {
  static const std::vector<glm::dvec3> all = nodes();
  static const double narrow = 1 / (node_width() * node_width());
  std::vector<double> out;
  const auto normalize = [&] {
    double sum = 0;
    for (const double w : out) sum += w;
    for (double& w : out) w /= sum;
  };
  for (const glm::dvec3& node : all) out.push_back(std::exp(-narrow * glm::dot(node - d, node - d)));
  normalize();
  for (double& w : out)
    if (w <= kLeastWeight) w = 0;
  normalize();
  return out;
}

}  // namespace

std::vector<glm::dvec3> on_disc(std::size_t count) {
  std::vector<glm::dvec3> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double r2 = (static_cast<double>(i) + 0.5) / static_cast<double>(count), r = std::sqrt(r2);
    const double phi = static_cast<double>(i) * pi * (3 - std::sqrt(5.0));
    out.emplace_back(r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r2));
  }
  return out;
}

std::vector<glm::dvec3> nodes() {
  std::vector<glm::dvec3> out = on_disc(kNodes);
  for (glm::dvec3& node : out) {
    node = glm::dvec3(glm::ivec3(glm::round(node * 1000.0))) / 1000.0;  // as info.json has them
  }
  return out;
}

double node_width() { return 0.18; }

std::vector<double> terms_of(Format format, const glm::dvec3& to_light) {
  switch (format) {
    case Format::kPtm:
      return polynomials(to_light);
    case Format::kHsh:
      return harmonics(to_light);
    case Format::kBilinear:
      return grid(to_light);
    case Format::kRbf:
      return gaussians(to_light);
    case Format::kLp:
      break;
  }
  return {};
}

}  // namespace likeness::realis
