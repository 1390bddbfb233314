#include "datasets_synthetic/scene_shapes.h"

#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

namespace likeness::datasets_synthetic {
namespace {

constexpr double kStep = 1e-5;  // of the differences for normals

double lattice(int x, int y, unsigned seed) {
  // SplitMix64's last steps (Steele, Lea and Flood 2014), over both numbers and the seed.
  std::uint64_t h = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32 | static_cast<std::uint32_t>(y)) +
                    0x9e3779b97f4a7c15u * (seed + 1);
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
  h ^= h >> 31;
  return static_cast<double>(h >> 11) * 0x1p-52 - 1;
}

double joined(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

}  // namespace

scene::Mesh mesh_of(const Surface& surface, int steps_s, int steps_t) {
  scene::Mesh mesh;
  const auto position = [&](double s, double t) { return surface(s, t).position; };
  for (int j = 0; j <= steps_t; ++j)
    for (int i = 0; i <= steps_s; ++i) {
      const double s = static_cast<double>(i) / steps_s, t = static_cast<double>(j) / steps_t;
      const SurfacePoint point = surface(s, t);
      // A pole has no derivative along s: its normal is taken a little beside it.
      const double beside = std::fmin(std::fmax(t, 1e-3), 1 - 1e-3);
      const glm::dvec3 along = position(s + kStep, beside) - position(s - kStep, beside);
      const glm::dvec3 down = position(s, beside + kStep) - position(s, beside - kStep);
      mesh.positions.emplace_back(point.position);
      mesh.normals.emplace_back(glm::normalize(glm::cross(down, along)));
      mesh.uvs.emplace_back(point.uv);
    }
  const auto at = [&](int i, int j) { return static_cast<scene::Index>(j * (steps_s + 1) + i); };
  const auto differ = [&](scene::Index a, scene::Index b) {
    return glm::length(mesh.positions[a] - mesh.positions[b]) > 1e-9f;
  };
  for (int j = 0; j < steps_t; ++j)
    for (int i = 0; i < steps_s; ++i) {
      const scene::Index a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if (differ(a, b)) mesh.triangles.push_back({a, c, b});
      if (differ(c, d)) mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

double noise(double x, double y, unsigned seed, int period) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto column = [&](int i) {
    const int at = static_cast<int>(fx) + i;
    return period > 0 ? (at % period + period) % period : at;
  };
  const int row = static_cast<int>(fy);
  const double u = joined(x - fx), v = joined(y - fy);
  const double top = lattice(column(0), row, seed) * (1 - u) + lattice(column(1), row, seed) * u;
  const double bottom = lattice(column(0), row + 1, seed) * (1 - u) + lattice(column(1), row + 1, seed) * u;
  return top * (1 - v) + bottom * v;
}

double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

double rough_noise(double x, double y, unsigned seed, int period) {
  double sum = 0, size = 0.5, step = 1;
  for (unsigned octave = 0; octave < 4; ++octave, size /= 2, step *= 2)
    sum += size * noise(x * step, y * step, seed + octave, period * static_cast<int>(step));
  return sum;
}

}  // namespace likeness::datasets_synthetic
