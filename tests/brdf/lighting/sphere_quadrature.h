#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "brdf/vector.h"

namespace likeness::brdf {

// Gauss and Legendre's rule of 16 points on [low, high]: exact for polynomials of degree 31.
template <class F>
double over_interval(double low, double high, F&& f) {
  static const auto kRule = [] {
    std::array<std::array<double, 2>, 16> rule{};
    for (std::size_t i = 0; i < 16; ++i) {
      long double x = std::cos(std::numbers::pi_v<long double> * (i + 0.75L) / 16.5L), slope = 1;
      for (int step = 0; step < 20; ++step) {
        long double p = 1, before = 0;
        for (int n = 1; n <= 16; ++n) {
          const long double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
          before = p;
          p = next;
        }
        slope = 16 * (x * p - before) / (x * x - 1);
        x -= p / slope;
      }
      rule[i] = {double(x), double(2 / ((1 - x * x) * slope * slope))};
    }
    return rule;
  }();
  double sum = 0;
  for (const auto& [x, w] : kRule) sum += w * f(low + (high - low) * (x + 1) / 2);
  return sum * (high - low) / 2;
}

// Over directions with z in [low, high]; exact for spherical harmonics up to degree 31.
template <class F>
double over_sphere(F&& f, double low = -1, double high = 1) {
  return over_interval(low, high, [&](double z) {
    const double r = std::sqrt((1 - z) * (1 + z));
    double sum = 0;
    for (int i = 0; i < 32; ++i) {
      const double phi = 2 * std::numbers::pi * i / 32;
      sum += f(Vec3<double>(r * std::cos(phi), r * std::sin(phi), z));
    }
    return sum * 2 * std::numbers::pi / 32;
  });
}

}  // namespace likeness::brdf
