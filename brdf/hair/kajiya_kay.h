#pragma once

#include <numbers>
#include <tuple>

#include "brdf/parameter.h"
#include "brdf/vector.h"

namespace likeness::brdf {

// cos^n(angle) where the cosine is positive, 0 elsewhere, from versine = 1 - cos(angle): near the peak a cosine has lost
// the angle, a versine has not. n >= 0.
template <Scalar S>
S power_of_cosine(const S& versine, const S& n) {
  const auto usable = greater(S(1), versine);
  return pick(usable, S(exp(S(n * log1p(S(-pick(usable, versine, S(0))))))), S(0));
}

// Hair as it was shaded before there was physics in it: a diffuse term, two highlights and a term for light from behind.
//
//     S cos(theta_i) = d cos(theta_i) / pi^2
//                    + sum over both highlights of k c(n) cos^n(theta_i + theta_o - shift)
//                    + t c(m) cos^m(theta_i + theta_o) B(phi)                                          [1/sr]
//     c(n) = sqrt(n + 1.5) / (2 pi)^1.5,     B(phi) = 5.092 ((1 - cos phi) / 2)^8
//
// Frame, directions, theta and phi as for HairFibre; phi = phi_i - phi_o. Each cos^n is 0 where its cosine is negative.
// Source      Kajiya and Kay 1989; the slide 'Phenomenological' of the Enemies talk: S = k_d + k_s cos^n / cos(theta_i),
//             with dual highlights and a transmission term, which it does not write out.
// Departures  the terms are scaled so that each weight is the energy of its term seen across the fibre (within 2.4 % at
//             n = 0, 1 % at 1, 0.1 % above 10); the transmission's form is ours.
// Does not    conserve or bound energy but by its weights; is not reciprocal (the 1 / cos(theta_i)).
template <Scalar S>
struct KajiyaKay {
  static constexpr std::string_view kName = "kajiya_kay";
  static constexpr std::string_view kText = "phenomenological hair: diffuse, two highlights, transmission";
  // clang-format off
  static constexpr std::array kParameters{
      Parameter{.name = "diffuse", .initial = 0.2, .range = {0, 1}, .typical = {0, 0.5}, .role = Role::kScale,
                .channels = 3, .text = "energy of the diffuse term, linear RGB"},
      Parameter{.name = "primary", .initial = 0.1, .range = {0, 1}, .typical = {0, 0.3}, .role = Role::kScale,
                .channels = 3, .text = "energy of the first highlight (R), linear RGB"},
      Parameter{.name = "secondary", .initial = 0.1, .range = {0, 1}, .typical = {0, 0.3}, .role = Role::kScale,
                .channels = 3, .text = "energy of the second highlight (TRT), linear RGB"},
      Parameter{.name = "transmission", .initial = 0.2, .range = {0, 1}, .typical = {0, 0.8}, .role = Role::kScale,
                .channels = 3, .text = "energy of the light from behind (TT), linear RGB"},
      Parameter{.name = "primary_exponent", .initial = 80, .range = {0, 1e5}, .typical = {10, 400},
                .logarithmic = true, .text = "sharpness of the first highlight"},
      Parameter{.name = "secondary_exponent", .initial = 20, .range = {0, 1e5}, .typical = {4, 100},
                .logarithmic = true, .text = "sharpness of the second highlight"},
      Parameter{.name = "transmission_exponent", .initial = 100, .range = {0, 1e5}, .typical = {10, 400},
                .logarithmic = true, .text = "sharpness along the fibre of the light from behind"},
      Parameter{.name = "primary_shift_deg", .initial = -4, .range = {-40, 40}, .typical = {-10, 0}, .unit = "deg",
                .role = Role::kAngle, .text = "theta_i + theta_o at the first highlight; negative is towards the root"},
      Parameter{.name = "secondary_shift_deg", .initial = 8, .range = {-40, 40}, .typical = {0, 20}, .unit = "deg",
                .role = Role::kAngle, .text = "theta_i + theta_o at the second highlight"},
  };
  // clang-format on
  static constexpr auto members() {
    return std::tuple{&KajiyaKay::diffuse,
                      &KajiyaKay::primary,
                      &KajiyaKay::secondary,
                      &KajiyaKay::transmission,
                      &KajiyaKay::primary_exponent,
                      &KajiyaKay::secondary_exponent,
                      &KajiyaKay::transmission_exponent,
                      &KajiyaKay::primary_shift_deg,
                      &KajiyaKay::secondary_shift_deg};
  }
  Rgb<S> diffuse{constant<S>(kParameters[0].initial)}, primary{constant<S>(kParameters[1].initial)},
      secondary{constant<S>(kParameters[2].initial)}, transmission{constant<S>(kParameters[3].initial)};
  S primary_exponent = constant<S>(kParameters[4].initial), secondary_exponent = constant<S>(kParameters[5].initial),
    transmission_exponent = constant<S>(kParameters[6].initial),
    primary_shift_deg = constant<S>(kParameters[7].initial), secondary_shift_deg = constant<S>(kParameters[8].initial);

  // What the formula reads of a pair of directions.
  template <Scalar T>
  struct Angles {
    T cos_i;                        // of theta_i, not negative
    T versine, primary, secondary;  // 1 - cos of theta_i + theta_o, and of it less the shift of each highlight
    T behind;                       // (1 - cos phi) / 2
  };
  Angles<S> angles(const S& theta_i, const S& theta_o, const S& phi) const {
    const S sum = theta_i + theta_o;
    const auto versine = [&](const S& shift_deg) {
      const S sine = sin(S((sum - shift_deg * constant<S>(std::numbers::pi / 180)) * S(0.5)));
      return S(S(2) * sine * sine);
    };
    const S half = sin(S(phi * S(0.5)));
    return {positive(S(cos(theta_i))), versine(S(0)), versine(primary_shift_deg), versine(secondary_shift_deg),
            S(half * half)};
  }

  // S cos(theta_i), [1/sr].
  template <Scalar T>
  Rgb<S> eval_cos(const Angles<T>& a) const {
    const auto lobe = [](const T& versine, const S& n) {
      constexpr double kScale = 0.063493635934240969;  // (2 pi)^-1.5
      return S(constant<S>(kScale) * sqrt(S(n + S(1.5))) * power_of_cosine(S(versine), n));
    };
    const T b2 = a.behind * a.behind, b4 = b2 * b2;
    constexpr double kAround = 5.0921911421911421;  // 2^15 / 6435: the mean of sin^16 is its inverse
    const S d = S(a.cos_i * constant<T>(1 / (std::numbers::pi * std::numbers::pi)));
    return diffuse * d + primary * lobe(a.primary, primary_exponent) +
           secondary * lobe(a.secondary, secondary_exponent) +
           transmission * S(lobe(a.versine, transmission_exponent) * T(b4 * b4 * constant<T>(kAround)));
  }
  // S, [1/sr], without the cosine, which is held above 1e-18.
  template <Scalar T>
  Rgb<S> eval(const Angles<T>& a) const {
    return eval_cos(a) * T(T(1) / larger(a.cos_i, constant<T>(1e-18)));
  }
};

}  // namespace likeness::brdf
