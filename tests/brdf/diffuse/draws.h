#pragma once

#include <cmath>
#include <numbers>

#include "brdf/diffuse/microfacet_diffuse.h"

// Roughnesses and pairs of directions, over which the forms of microfacet_diffuse are fitted and compared.
namespace likeness::brdf {

enum class Directions { kByCosine, kUniform };

struct Draw {
  double alpha, cos_o, cos_i, phi;

  PolarPair<double> pair() const { return PolarPair<double>::at(std::acos(cos_o), std::acos(cos_i), phi); }
};

// The n-th of a sequence that fills (alpha, direction, direction) evenly: alpha uniform in [0, 1], directions over the
// hemisphere by solid angle, weighted by the cosine or not, and phi in [0, pi], since nothing depends on its sign.
// Source  Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences": an additive recurrence by the powers
//         of 1 / g, where g^5 = g + 1.
inline Draw draw(int n, Directions directions) {
  constexpr double kG = 1.1673039782614187;
  const auto fraction = [&](int axis) {
    const double x = 0.5 + n * std::pow(kG, -axis);
    return x - std::floor(x);
  };
  const auto cosine = [&](double u) { return directions == Directions::kByCosine ? std::sqrt(u) : u; };
  // Away from the horizon itself, where the integral over the cosines has its pole: no draw comes nearer than this.
  const auto above = [](double c) { return c > 1e-4 ? c : 1e-4; };
  return {fraction(1), above(cosine(fraction(2))), above(cosine(fraction(3))), std::numbers::pi * fraction(4)};
}

}  // namespace likeness::brdf
