#pragma once

#include <cmath>
#include <numbers>

#include "brdf/subsurface/random_walk.h"

// What is known exactly of the half space that scatters isotropically behind a boundary that does nothing: how much of
// the light comes back. It proves the random walk, and leads from a surface albedo to the medium that has it.
namespace likeness::brdf {

// Integrates f(theta, pi/2 - theta) over theta from 0 to pi/2 with the double-exponential rule of Takahasi and Mori 1974:
// singularities at the ends do no harm. Near an end the second argument has the digits that the first has lost.
template <class F>
double integral_over_quarter(F&& f) {
  constexpr double kStep = 1.0 / 16, kQuarter = std::numbers::pi / 2;
  double sum = 0;
  for (int i = -56; i <= 56; ++i) {
    const double t = i * kStep, s = kQuarter * std::sinh(t);
    const double part = 1 / (1 + std::exp(-2 * s)), rest = 1 / (1 + std::exp(2 * s));  // part + rest = 1
    sum += f(kQuarter * part, kQuarter * rest) * 2 * kQuarter * std::cosh(t) * part * rest;
  }
  return sum * kQuarter * kStep;
}

// Chandrasekhar's H of isotropic scattering, at the cosine mu in [0, 1], for the single-scattering albedo alpha in [0, 1]:
//
//     ln H = -mu / pi * integral over theta in (0, pi/2) of ln(1 - alpha theta cot theta) / (cos^2 + mu^2 sin^2)
//
// Source  Chandrasekhar, 'Radiative Transfer', chapter V: the solution in closed form of his integral equation
//         1 / H(mu) = sqrt(1 - alpha) + alpha / 2 * integral of x H(x) / (mu + x), with the tangent of theta for the
//         variable. Within 1e-13 of 25 digits.
inline double chandrasekhar_h(double mu, double alpha) {
  return std::exp(-mu / std::numbers::pi * integral_over_quarter([&](double theta, double rest) {
    const double c = std::sin(rest), s = std::sin(theta), t2 = theta * theta;
    const double q = theta < 0.01 ? t2 * (1.0 / 3 + t2 / 45) : 1 - theta * c / s;  // 1 - theta cot theta
    const double log = alpha > 0.5 ? std::log(1 - alpha + alpha * q) : std::log1p(alpha * (q - 1));
    return log / (c * c + mu * mu * s * s);
  }));
}

// The part of the light that comes back. At the cosine mu: 1 - H(mu) sqrt(1 - alpha); from all sides: its mean over
// 2 mu d mu. Source  Chandrasekhar, chapter V; van de Hulst, 'Multiple Light Scattering', for the names of the two:
// plane and spherical albedo.
inline double plane_albedo(double mu, double alpha) { return 1 - chandrasekhar_h(mu, alpha) * std::sqrt(1 - alpha); }
inline double spherical_albedo(double alpha) {
  // mu = sin^2 theta: H is not smooth in mu at 0.
  return integral_over_quarter([&](double theta, double rest) {
    const double c = std::sin(rest), s = std::sin(theta), mu = s * s;
    return plane_albedo(mu, alpha) * 2 * mu * 2 * s * c;
  });
}
inline double surface_albedo(double alpha, Incidence incidence) {
  return incidence == Incidence::kPencil ? plane_albedo(1, alpha) : spherical_albedo(alpha);
}

// The single-scattering albedo at which a surface has the albedo A in [0, 1).
inline double single_scattering_albedo(double albedo, Incidence incidence) {
  double low = 0, high = 1;  // of sqrt(1 - alpha), in which the albedo falls almost along a straight line
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (surface_albedo((1 - middle) * (1 + middle), incidence) > albedo ? low : high) = middle;
  }
  return (1 - low) * (1 + low);
}

}  // namespace likeness::brdf
