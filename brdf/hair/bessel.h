#pragma once

#include <array>
#include <cstddef>

#include "brdf/scalar.h"

namespace likeness::brdf {

// c[0] + c[1] x + c[2] x^2 + ..., by Horner's rule.
template <Scalar S, std::size_t N>
S polynomial(const std::array<double, N>& c, const S& x) {
  S sum = constant<S>(c[N - 1]);
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * x + constant<S>(c[i]);
  return sum;
}

// Rational fits of exp(-x) I0(x) for x <= 8, in x / 8, and of sqrt(x) exp(-x) I0(x) for x >= 8, in 16 / x - 1: minimax
// by reweighted least squares in 45 digits (brdf/hair/fit_bessel.py prints them). Relative error of the fits: 1.4e-16 and
// 1.3e-16 for double; 1.5e-8 and 8.6e-9 for float.
template <class Number>
struct BesselFit {
  // clang-format off
  static constexpr std::array kNearTop{
      1.00000000000000014, 0.359764066431073862, 14.4345394841546212, 5.03646675492501176, 40.2578517419454598,
      12.3010851522855237, 33.723643810509748, 6.9040170883525315, 7.52868803092784388, -0.0924817361670383961,
      0.08362591881444567, -0.00755253032347012088};
  static constexpr std::array kNearBottom{
      1.0, 8.35976406643126358, 33.3126520155600747, 83.6023410282176259, 146.818950518270292,
      189.082253369647474, 181.094476759690156, 126.880670107081201, 60.8783592137091379, 16.269828855305099};
  static constexpr std::array kFarTop{
      0.402176509445008031, -0.928993375945807893, 1.54570962150944443, -1.53445060397943286,
      1.05013015285623701, -0.445047387092007488, 0.111066202602798848, -0.0116950247408092578,
      0.000271314250059000281, 7.09526725194254905e-7};
  static constexpr std::array kFarBottom{
      1.0, -2.31827047585672647, 3.86239384300430265, -3.84688240179761599, 2.64201415244474716,
      -1.12746988277719999, 0.284782854388483604, -0.0311385337686131371, 0.000862006790599863168};
  // clang-format on
};
template <>
struct BesselFit<float> {
  static constexpr std::array kNearTop{0.999999986, -0.831404394, 13.226276,   -11.0323264, 24.5614389,
                                       -20.2526148, 11.5672929,   -3.92290812, 0.597164587};
  static constexpr std::array kNearBottom{1.0, 7.16858748, 22.5757522, 38.785166, 34.4426984};
  static constexpr std::array kFarTop{0.402176513,   0.0033605579,  0.000136156799,
                                      1.11036115e-5, 1.63835555e-6, 3.69393134e-7};
  static constexpr std::array kFarBottom{1.0};
};

// exp(-x) I0(x), [1], x >= 0, where I0 is the modified Bessel function of order 0: 1 at 0, falls as 1 / sqrt(2 pi x).
// Never overflows. Relative error 1.2e-15 in double and 2.2e-7 in float, over [0, 1e300] and [0, 1e38].
// Both fits are evaluated and one is kept, so that a batch needs no branch; they meet at 8 to 2e-16.
template <Scalar S>
S bessel_i0_scaled(const S& x) {
  using Fit = BesselFit<typename Arithmetic<S>::Number>;
  const auto far = greater(x, S(8));
  const S near_x = smaller(x, S(8)) * S(0.125), far_x = larger(x, S(8)), t = S(16) / far_x - S(1);
  const S top = pick(far, polynomial(Fit::kFarTop, t), polynomial(Fit::kNearTop, near_x));
  const S bottom = pick(far, S(polynomial(Fit::kFarBottom, t) * sqrt(far_x)), polynomial(Fit::kNearBottom, near_x));
  return top / bottom;
}

}  // namespace likeness::brdf
