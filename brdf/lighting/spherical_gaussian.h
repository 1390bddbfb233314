#pragma once

#include <numbers>

#include "brdf/vector.h"

namespace likeness::brdf {

// 1 - cos of the angle between unit vectors, from their difference: it keeps its digits where they coincide.
template <Scalar S>
S versine_between(const Vec3<S>& a, const Vec3<S>& b) {
  const Vec3<S> difference = a - b;
  return S(0.5) * dot(difference, difference);
}

// The mean of exp(-t) over t in [0, x], (1 - exp(-x)) / x; 1 at x = 0. x >= 0.
template <Scalar S>
S mean_decay(const S& x) {
  const auto large = greater(x, constant<S>(1e-5));
  const S quotient = -expm1(S(-pick(large, x, S(1)))) / pick(large, x, S(1));
  return pick(large, quotient, S(S(1) - S(0.5) * x * (S(1) - constant<S>(1.0 / 3) * x)));
}

// A Gaussian on the sphere, amplitude exp(-sharpness (1 - cos)), with the angle to its axis.
//
// Source  Wang et al. 2009 ("All-frequency rendering of dynamic, spatially-varying reflectance"), section 3, as are the
//         product and the integral; here without the cancellation of lambda_m - lambda_a - lambda_b.
// Holds   sharpness from 0 (the same in all directions) to 1e6 and beyond; not below 0.
template <Scalar S>
struct SphericalGaussian {
  Vec3<S> axis{S(0), S(0), S(1)};  // unit
  S sharpness = S(1);              // lambda
  S amplitude = S(1);

  S eval(const Vec3<S>& direction) const { return eval(versine_between(axis, direction)); }
  S eval(const S& versine) const { return amplitude * exp(S(-sharpness * versine)); }

  // Over the sphere: amplitude 2 pi (1 - exp(-2 sharpness)) / sharpness; 4 pi amplitude at sharpness 0.
  S integral() const { return constant<S>(4 * std::numbers::pi) * amplitude * mean_decay(S(S(2) * sharpness)); }
};

// a b, which is one Gaussian. Where two equal ones are opposite the product is constant: its axis is then a's.
template <Scalar S>
SphericalGaussian<S> operator*(const SphericalGaussian<S>& a, const SphericalGaussian<S>& b) {
  // In units of the larger sharpness, so that neither tiny nor huge ones lose their squares.
  const S unit = larger(larger(a.sharpness, b.sharpness), constant<S>(kTiny<S> * kTiny<S>));
  const S in_a = a.sharpness / unit, in_b = b.sharpness / unit;
  const Vec3<S> sum = a.axis * in_a + b.axis * in_b;
  const S length2 = dot(sum, sum);
  const auto usable = greater(length2, constant<S>(kTiny<S>));
  const S length = S(sqrt(pick(usable, length2, S(1)))), share = pick(usable, length, S(0));
  SphericalGaussian<S> out;
  out.axis = {pick(usable, S(sum.x / length), a.axis.x), pick(usable, S(sum.y / length), a.axis.y),
              pick(usable, S(sum.z / length), a.axis.z)};
  out.sharpness = unit * share;
  // lambda_a + lambda_b - lambda_m, multiplied by its conjugate.
  const S total = larger(S(in_a + in_b + share), constant<S>(kTiny<S>));
  const S loss = S(2) * a.sharpness * versine_between(a.axis, b.axis) * (in_b / total);
  out.amplitude = a.amplitude * b.amplitude * exp(S(-loss));
  return out;
}

// The integral of a b over the sphere.
template <Scalar S>
S inner_product(const SphericalGaussian<S>& a, const SphericalGaussian<S>& b) {
  return (a * b).integral();
}

// A Gaussian of compact support: the one above times a smoothstep in its own exponent x = sharpness (1 - cos),
//
//     G = amplitude exp(-x) W(1 - x / ln 100),   W(t) = t^2 (3 - 2 t), t clamped to [0, 1]
//
// which is 1 on the axis and 0, with slope 0, from the angle on where the Gaussian has fallen to 1 %. A Gaussian that
// does not fall that far (sharpness below ln 100 / 2 = 2.30) covers the sphere; at sharpness 0 it is the plain one.
//
// Source  "The Rendering of The Callisto Protocol" names windowed spherical Gaussians and gives no form; this is the
//         project's: 'a smoothstep from the angle where the Gaussian falls to 1 % up to the axis'.
template <Scalar S>
struct WindowedGaussian {
  static constexpr double kEnd = 4.605170185988091;  // ln 100

  SphericalGaussian<S> plain;

  S eval(const Vec3<S>& direction) const { return eval(versine_between(plain.axis, direction)); }
  S eval(const S& versine) const {
    const S t = positive(S(S(1) - plain.sharpness * versine * constant<S>(1 / kEnd)));
    return plain.eval(versine) * (t * t * (S(3) - S(2) * t));
  }

  // Cosine of the angle at which the support ends; -1 if it is the sphere.
  S support() const {
    const S versine = constant<S>(kEnd) / larger(plain.sharpness, constant<S>(kEnd / 2));
    return S(1) - versine;
  }

  // Over the sphere, in closed form. With u = min(2 sharpness, ln 100) it is 4 pi amplitude times the mean of
  // exp(-x) (1 - 3 (x / ln 100)^2 + 2 (x / ln 100)^3) over [0, u], times u / (2 sharpness).
  S integral() const {
    const S whole = S(2) * plain.sharpness, u = smaller(whole, constant<S>(kEnd)), e = exp(S(-u));
    const S v = u * constant<S>(1 / kEnd);
    // n-th moments of exp(-u t) over [0, 1]: in closed form, and by a series where that cancels.
    const auto long_way = greater(u, S(1));
    const S w = pick(long_way, u, S(1));
    const S second = (S(2) - e * (w * w + S(2) * w + S(2))) / (w * w * w);
    const S third = (S(6) - e * (w * w * w + S(3) * w * w + S(6) * w + S(6))) / (w * w * w * w);
    const S m2 = pick(long_way, second, moment<2>(u)), m3 = pick(long_way, third, moment<3>(u));
    const S mean = mean_decay(u) - v * v * (S(3) * m2 - S(2) * v * m3);
    const auto ends = greater(whole, constant<S>(kEnd));
    const S share = pick(ends, S(u / pick(ends, whole, S(1))), S(1));
    return constant<S>(4 * std::numbers::pi) * plain.amplitude * mean * share;
  }

 private:
  // Sum over k of (-u)^k / (k! (k + n + 1)), u <= 1.
  template <int n>
  static S moment(const S& u) {
    S sum(0.0);
    double factorial = 1;
    S power(1.0);
    for (int k = 0; k < 19; ++k) {
      if (k > 0) factorial *= k;
      sum = sum + power * constant<S>(1 / (factorial * (k + n + 1)));
      power = power * (-u);
    }
    return sum;
  }
};

}  // namespace likeness::brdf
