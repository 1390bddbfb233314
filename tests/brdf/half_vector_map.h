#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "brdf/vector.h"

// Integrals over the light's hemisphere, and bins in it, that resolve a lobe of any sharpness.
namespace likeness::brdf {

// Nodes and weights of Gauss and Legendre on [0, 1], by Newton's method on the polynomial.
struct GaussLegendre {
  std::vector<double> node, weight;

  explicit GaussLegendre(int n) : node(std::size_t(n)), weight(std::size_t(n)) {
    for (int i = 0; i < n; ++i) {
      double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1;
      for (int step = 0; step < 100; ++step) {
        double p = 1, before = 0;
        for (int k = 0; k < n; ++k) {
          const double next = ((2 * k + 1) * x * p - k * before) / (k + 1);
          before = p;
          p = next;
        }
        slope = n * (x * p - before) / (x * x - 1);
        const double change = p / slope;
        x -= change;
        if (std::abs(change) < 1e-15) break;
      }
      node[std::size_t(i)] = 0.5 * (1 - x);
      weight[std::size_t(i)] = 1 / ((1 - x * x) * slope * slope);
    }
  }
};

// The square (x, y) in [0, 1]^2 onto the directions above the horizon, for one view, by the half vector: light is the
// view mirrored at the half vector of polar angle theta and azimuth psi from the view's.
//
// theta = a sinh(x asinh(end / a)), so that a lobe of width a spreads over x. The light is above the horizon for
// theta < end(psi) = (pi / 2 + delta) / 2, delta = atan2(sin_o cos psi, cos_o): a light is never cut by the edge of the
// square, so what is smooth in directions is smooth in x. At a grazing view `end` falls from pi / 2 to 0 within
// cos_o of psi = +-pi / 2; y is graded towards there in the same way. y in quarters: smooth between whole fourths.
class HalfVectorMap {
 public:
  // `sharpest`: the slope roughness of the narrowest lobe, 1 if there is none.
  HalfVectorMap(const Vec3<double>& to_view, double sharpest)
      : view_(to_view),
        sine_(std::hypot(to_view.x, to_view.y)),
        azimuth_(sine_ > 0 ? std::atan2(to_view.y, to_view.x) : 0),
        a_(sharpest),
        b_(to_view.z) {}

  struct Point {
    Vec3<double> to_light;
    double area;  // solid angle of the light for a unit of the square, [sr]
  };
  // The points of one y.
  struct Row {
    Vec3<double> view;
    double a, stretch, cosine, sine, slope;  // of the azimuth: its cosine and sine, d psi / d y

    Point at(double x) const {
      const double theta = a * std::sinh(x * stretch), s = std::sin(theta);
      const Vec3<double> h{s * cosine, s * sine, std::cos(theta)};
      const double across = dot(view, h);
      return {h * (2 * across) - view, 4 * across * s * slope * stretch * std::hypot(a, theta)};
    }
  };
  Row row(double y) const {
    const double side = y < 0.5 ? -1 : 1, from_right_angle = 4 * y - (y < 0.5 ? 1 : 3);
    const double turn = std::asinh(0.5 * std::numbers::pi / b_);
    const double psi = side * (0.5 * std::numbers::pi) + b_ * std::sinh(from_right_angle * turn);
    return {view_,
            a_,
            std::asinh(end(psi) / a_),
            std::cos(psi + azimuth_),
            std::sin(psi + azimuth_),
            4 * b_ * turn * std::cosh(from_right_angle * turn)};
  }
  Point at(double x, double y) const { return row(y).at(x); }

  struct Place {
    double x, y;
  };
  // The inverse of at(). Needs to_light above the horizon.
  Place place_of(const Vec3<double>& to_light) const {
    const Vec3<double> h = to_light + view_;
    double psi = std::atan2(h.y, h.x) - azimuth_;
    psi -= 2 * std::numbers::pi * std::floor(psi / (2 * std::numbers::pi) + 0.5);
    const double theta = std::atan2(std::hypot(h.x, h.y), h.z), side = psi < 0 ? -1 : 1;
    const double turn = std::asinh(0.5 * std::numbers::pi / b_);
    const double from_right_angle = std::asinh((psi - side * (0.5 * std::numbers::pi)) / b_) / turn;
    return {std::asinh(theta / a_) / std::asinh(end(psi) / a_), (from_right_angle + (side < 0 ? 1 : 3)) / 4};
  }

 private:
  double end(double psi) const { return 0.25 * std::numbers::pi + 0.5 * std::atan2(sine_ * std::cos(psi), view_.z); }

  Vec3<double> view_;
  double sine_, azimuth_, a_, b_;
};

// Calls visit(to_light, weight) at the nodes of a quadrature over the light's hemisphere, [sr]: `across` nodes in each
// fourth of the azimuth, `along` in the polar angle.
template <class F>
void for_each_light(const Vec3<double>& to_view, double sharpest, int along, int across, F&& visit) {
  const HalfVectorMap map(to_view, sharpest);
  const GaussLegendre in_x(along), in_y(across);
  for (int fourth = 0; fourth < 4; ++fourth)
    for (std::size_t k = 0; k < in_y.node.size(); ++k) {
      const auto row = map.row((fourth + in_y.node[k]) / 4);
      for (std::size_t i = 0; i < in_x.node.size(); ++i) {
        const auto point = row.at(in_x.node[i]);
        visit(point.to_light, point.area * in_x.weight[i] * in_y.weight[k] / 4);
      }
    }
}

}  // namespace likeness::brdf
