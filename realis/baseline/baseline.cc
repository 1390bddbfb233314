#include "realis/baseline/baseline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <Eigen/Core>
#include <Eigen/QR>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace likeness::realis {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

glm::dvec2 plane(const glm::dvec3& d) { return {d.x, d.y}; }

// P_l^m without the sign of Condon and Shortley.
double legendre(unsigned l, unsigned m, double x) {
  double below = 0, value = 1;
  for (unsigned i = 1; i <= m; ++i) value *= (2 * i - 1) * std::sqrt(std::max(0.0, 1 - x * x));
  for (unsigned i = m + 1; i <= l; ++i) {
    const double next = ((2 * i - 1) * x * value - (i + m - 1) * below) / (i - m);
    below = value, value = next;
  }
  return value;
}

// H_l^m = sqrt(2) K_l^m cos(m phi) P_l^m(2 cos theta - 1), sin for m below 0, without the root for m = 0.
std::vector<double> hemispherical(unsigned bands, const glm::dvec3& d) {
  std::vector<double> out;
  const double x = 2 * std::clamp(d.z, 0.0, 1.0) - 1, phi = std::atan2(d.y, d.x);
  for (unsigned l = 0; l < bands; ++l)
    for (int m = -static_cast<int>(l); m <= static_cast<int>(l); ++m) {
      const auto size = static_cast<unsigned>(std::abs(m));
      double k = (2 * l + 1) / (2 * std::numbers::pi);
      for (unsigned i = l - size + 1; i <= l + size; ++i) k /= i;
      const double turn = m == 0 ? 1 : std::numbers::sqrt2 * (m > 0 ? std::cos(m * phi) : std::sin(-m * phi));
      out.push_back(std::sqrt(k) * turn * legendre(l, size, x));
    }
  return out;
}

double kernel(Relighter relighter, double r, double width) {
  if (relighter == Relighter::kGaussian) return std::exp(-(r / width) * (r / width));
  return r > 0 ? r * r * std::log(r) : 0;
}

double twice(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

struct Weighted {
  std::array<std::size_t, 3> lights;
  std::array<double, 3> weights;
};

constexpr double kOnEdge = 1e-9;

std::optional<Weighted> triangle_around(std::span<const glm::dvec2> p, const glm::dvec2& q) {
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t j = i + 1; j < p.size(); ++j)
      for (std::size_t k = j + 1; k < p.size(); ++k) {
        const double area = twice(p[i], p[j], p[k]);
        if (std::abs(area) < kOnEdge) continue;
        const double a = twice(q, p[j], p[k]) / area, b = twice(p[i], q, p[k]) / area, c = 1 - a - b;
        if (a < -kOnEdge || b < -kOnEdge || c < -kOnEdge) continue;
        // The middle of the circle through all three; nobody else may be within.
        const glm::dvec2 u = p[j] - p[i], v = p[k] - p[i];
        const double uu = glm::dot(u, u), vv = glm::dot(v, v);
        const glm::dvec2 middle = glm::dvec2(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / (2 * area);
        const double radius = glm::length(middle) * (1 - kOnEdge);
        if (std::none_of(p.begin(), p.end(),
                         [&](const glm::dvec2& x) { return glm::length(x - p[i] - middle) < radius; }))
          return Weighted{{i, j, k}, {a, b, c}};
      }
  return std::nullopt;
}

// All segments between lights are within their hull, so the nearest point of all of them is that of an edge.
Weighted nearest_edge(std::span<const glm::dvec2> p, const glm::dvec2& q) {
  Weighted best{{0, 0, 0}, {1, 0, 0}};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t j = i; j < p.size(); ++j) {
      const glm::dvec2 u = p[j] - p[i];
      const double length = glm::dot(u, u);
      const double t = length > 0 ? std::clamp(glm::dot(q - p[i], u) / length, 0.0, 1.0) : 0;
      const double distance = glm::length(p[i] + t * u - q);
      if (distance < least - kOnEdge) least = distance, best = {{i, j, j}, {1 - t, t, 0}};
    }
  return best;
}

}  // namespace

std::vector<double> terms_of(Relighter relighter, const glm::dvec3& d) {
  const double u = d.x, v = d.y;
  switch (relighter) {
    case Relighter::kPtm6:
      return {u * u, v * v, u * v, u, v, 1};
    case Relighter::kPtm10:
      return {u * u, v * v, u * v, u, v, 1, u * u * u, u * u * v, u * v * v, v * v * v};
    case Relighter::kHsh4:
      return hemispherical(2, d);
    case Relighter::kHsh9:
      return hemispherical(3, d);
    case Relighter::kHsh16:
      return hemispherical(4, d);
    default:
      return {};
  }
}

struct Baseline::Work {
  Relighter relighter;
  std::vector<glm::dvec2> lights;
  double width = 1;
  Matrix inverse;  // numbers that are stored x lights

  Vector row(const glm::dvec3& direction) const {
    if (std::vector<double> terms = terms_of(relighter, direction); !terms.empty())
      return Eigen::Map<const Vector>(terms.data(), static_cast<Eigen::Index>(terms.size()));
    const glm::dvec2 q = plane(direction);
    Vector out(static_cast<Eigen::Index>(lights.size()) + 3);
    for (std::size_t i = 0; i < lights.size(); ++i)
      out[static_cast<Eigen::Index>(i)] = kernel(relighter, glm::length(q - lights[i]), width);
    out.tail<3>() << 1, q.x, q.y;
    return out;
  }
};

Baseline::Baseline(Relighter relighter, std::span<const glm::dvec3> to_lights) {
  Work w{relighter, {}, 1, {}};
  for (const glm::dvec3& d : to_lights) w.lights.push_back(plane(d));
  const auto lights = static_cast<Eigen::Index>(to_lights.size());
  std::vector<double> nearest;
  for (std::size_t i = 0; i < w.lights.size(); ++i) {
    double least = 2;
    for (std::size_t j = 0; j < w.lights.size(); ++j)
      if (const double r = glm::length(w.lights[i] - w.lights[j]); j != i && r > kOnEdge) least = std::min(least, r);
    nearest.push_back(least);
  }
  if (!nearest.empty()) {
    std::nth_element(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2), nearest.end());
    w.width = 2 * nearest[nearest.size() / 2];
  }
  if (relighter != Relighter::kBarycentric && lights > 0) {
    const bool keeps = terms_of(relighter, {0, 0, 1}).empty();
    Matrix system = Matrix::Zero(keeps ? lights + 3 : lights, w.row({0, 0, 1}).size());
    for (Eigen::Index i = 0; i < lights; ++i) system.row(i) = w.row(to_lights[static_cast<std::size_t>(i)]).transpose();
    if (keeps) system.bottomLeftCorner(3, lights) = system.topRightCorner(lights, 3).transpose();
    w.inverse = Eigen::CompleteOrthogonalDecomposition<Matrix>(system).pseudoInverse().leftCols(lights);
  }
  work_ = std::make_unique<const Work>(std::move(w));
}
Baseline::~Baseline() = default;
Baseline::Baseline(Baseline&&) noexcept = default;

std::vector<double> Baseline::weights(const glm::dvec3& to_light) const {
  const Work& w = *work_;
  std::vector<double> out(w.lights.size(), 0.0);
  if (out.empty()) return out;
  if (w.relighter == Relighter::kBarycentric) {
    const auto around = triangle_around(w.lights, plane(to_light));
    const Weighted found = around ? *around : nearest_edge(w.lights, plane(to_light));
    for (std::size_t i = 0; i < 3; ++i) out[found.lights[i]] += found.weights[i];
    return out;
  }
  Eigen::Map<Vector>(out.data(), static_cast<Eigen::Index>(out.size())) = w.inverse.transpose() * w.row(to_light);
  return out;
}

std::size_t bytes_of(const RelighterRow& row, std::size_t lights, bool is_lrgb) {
  if (row.terms == 0) return 3 * lights;
  return is_lrgb ? row.terms + 3 : 3 * row.terms;
}

}  // namespace likeness::realis
