#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "brdf/blood/haemoglobin.h"
#include "brdf/parameter.h"
#include "brdf/scalar.h"
#include "brdf/vector.h"

namespace likeness::brdf {

// The color of a drop of blood by its opacity and its age: reflectance over a background, linear Rec. 709.
//
//     R = B T + b / (b + mu) (1 - T),   T = exp(-mu d)                                  at each wavelength
//     mu = absorption of haemoglobin with the oxygen saturation s(t)                    [1/mm]
//     d = thickness (-ln(1 - opacity))^bend                                             [mm]
//     s, b move from their fresh to their old value as exp(-t / time)
//
// then each channel times exp(opacity times a cubic spline over opacity and the logarithm of time), for what the spectra do
// not know: methaemoglobin, drying, shine.
//
// Source      Beer and Lambert; the reflectance of thick blood as that of a medium that scatters b back a millimetre. The form
//             of s and b in time is ours.
// Holds       opacity 0 is the background; R in [0, 1] where the spline is 0.
// Does not    know the shape of a drop, its rim, or its shine.
template <Scalar S>
struct BloodPalette {
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "thickness", .initial = 0.15, .range = {1e-4, 10}, .typical = {0.005, 0.3}, .unit = "mm", .role = Role::kScale,
                .text = "path through a drop of opacity 1 - 1/e"},
      Parameter{.name = "bend", .initial = 1, .range = {0.1, 4}, .typical = {0.5, 2},
                .text = "exponent of the path over opacity"},
      Parameter{.name = "fresh_saturation", .initial = 0.95, .range = {0, 1}, .typical = {0.6, 0.99},
                .text = "share of haemoglobin with oxygen at time 0"},
      Parameter{.name = "old_saturation", .initial = 0.5, .range = {0, 1}, .typical = {0.1, 0.9}, .text = "the same after long"},
      Parameter{.name = "saturation_time", .initial = 2400, .range = {1, 1e6}, .typical = {300, 10000}, .unit = "s",
                .text = "in which 63 % of that change is done"},
      Parameter{.name = "fresh_backscatter", .initial = 0.15, .range = {1e-4, 100}, .typical = {0.1, 3}, .unit = "1/mm",
                .text = "b at time 0"},
      Parameter{.name = "old_backscatter", .initial = 0.05, .range = {1e-4, 100}, .typical = {0.05, 3}, .unit = "1/mm",
                .text = "b of a dry drop"},
      Parameter{.name = "drying_time", .initial = 1200, .range = {1, 1e6}, .typical = {300, 10000}, .unit = "s",
                .text = "in which 63 % of that change is done"},
      Parameter{.name = "background", .initial = 0.8, .range = {0, 1}, .typical = {0.1, 0.95}, .text = "reflectance below the drop"},
  };
  // clang-format on
  static constexpr std::size_t kCount = kParameters.size();
  std::array<S, kCount> value = [] {
    std::array<S, kCount> out;
    for (std::size_t i = 0; i < kCount; ++i) out[i] = constant<S>(kParameters[i].initial);
    return out;
  }();

  // Coefficients of the spline, opacity first, then time; uniform cubic B-splines on [0, 1]^2.
  static constexpr std::size_t kAcross = 5, kAlong = 6;
  std::array<std::array<S, 3>, kAcross * kAlong> spline{};
  S longest = S(10800);  // time [s] at which the spline's second coordinate is 1

  // The largest opacity that makes a difference: -ln of what is left is then 6.9.
  static constexpr double kMostOpacity = 0.999;

  // The four weights of a uniform cubic B-spline with `count` coefficients at x in [0, 1], and the first one's index.
  static std::array<S, 4> basis(const S& x, std::size_t count, std::size_t& first) {
    const S at = clamp01(x) * S(double(count - 3));
    first = 0;
    while (first + 4 < count && greater(at, S(double(first + 1)))) ++first;
    const S t = at - S(double(first)), u = S(1) - t, t2 = t * t, t3 = t2 * t;
    const S sixth = constant<S>(1.0 / 6);
    return {u * u * u * sixth, (S(3) * t3 - S(6) * t2 + S(4)) * sixth,
            (S(-3) * t3 + S(3) * t2 + S(3) * t + S(1)) * sixth, t3 * sixth};
  }
  S time_coordinate(const S& time) const {
    return log(S(S(1) + larger(time, S(0)) / S(60))) / log(S(S(1) + longest / S(60)));
  }

  // The spectra alone. opacity in [0, 1], time in [s]; both are clamped.
  Rgb<S> spectral(const HaemoglobinWeights& weights, const S& opacity, const S& time) const {
    const auto moved = [&](const S& fresh, const S& old, const S& scale) {
      return S(old + (fresh - old) * exp(S(-larger(time, S(0)) / scale)));
    };
    const S saturation = moved(value[2], value[3], value[4]), back = moved(value[5], value[6], value[7]);
    const S bare = S(1) - smaller(larger(opacity, S(0)), constant<S>(kMostOpacity));
    const S depth = larger(S(-log(bare)), constant<S>(1e-12));
    const S path = value[0] * exp(S(value[1] * log(depth)));
    Rgb<S> sum;
    for (std::size_t i = 0; i < kHaemoglobinRows; ++i) {
      const S with = constant<S>(kHaemoglobin[i][0]), without = constant<S>(kHaemoglobin[i][1]);
      const S mu = constant<S>(kAbsorptionPerExtinction) * (without + saturation * (with - without));
      const S through = exp(S(-mu * path));
      const S r = value[8] * through + back / (back + mu) * (S(1) - through);
      sum = sum + Rgb<S>(constant<S>(weights.weight[i][0]), constant<S>(weights.weight[i][1]),
                         constant<S>(weights.weight[i][2])) *
                      r;
    }
    return sum;
  }

  // The palette. 0 or more in each channel.
  Rgb<S> color(const HaemoglobinWeights& weights, const S& opacity, const S& time) const {
    const Rgb<S> base = spectral(weights, opacity, time);
    std::size_t across = 0, along = 0;
    const std::array<S, 4> x = basis(opacity, kAcross, across), y = basis(time_coordinate(time), kAlong, along);
    const S part = clamp01(opacity);
    std::array<S, 3> bend{S(0), S(0), S(0)};
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t c = 0; c < 3; ++c)
          bend[c] = bend[c] + x[i] * y[j] * spline[(along + j) * kAcross + across + i][c];
    return {larger(base.r, S(0)) * exp(S(part * bend[0])), larger(base.g, S(0)) * exp(S(part * bend[1])),
            larger(base.b, S(0)) * exp(S(part * bend[2]))};
  }
};

}  // namespace likeness::brdf
