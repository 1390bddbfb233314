#pragma once

#include <cmath>
#include <concepts>
#include <type_traits>

// The arithmetic that every evaluator is written in, so that one source serves float, double,
// ceres::Jet (include brdf/jet.h) and SIMD batches (include brdf/batch.h), in any include order.
//
// Rules for code that uses it: S(2) instead of 2 beside an S, and constant<S>(0.3) where a float has to
// round; greater(a, b) and pick(mask, a, b) instead of `if` on a value.
namespace likeness::brdf {

// A type that evaluators can compute with: arithmetic, and a construction from a double.
template <class S>
concept Scalar = requires(S a, S b) {
  { a + b } -> std::convertible_to<S>;
  { a - b } -> std::convertible_to<S>;
  { a* b } -> std::convertible_to<S>;
  { a / b } -> std::convertible_to<S>;
  { -a } -> std::convertible_to<S>;
  S(0.0);
};

using std::abs;
using std::acos;
using std::asin;
using std::atan;
using std::atan2;
using std::cbrt;
using std::cos;
using std::exp;
using std::expm1;
using std::floor;
using std::log;
using std::log1p;
using std::sin;
using std::sqrt;
using std::tan;
using std::tanh;

// What a kind of scalar brings of its own. This is the plain number; Jets and batches specialise it.
template <class S>
struct Arithmetic {
  using Number = S;  // the plain number inside, which decides what is tiny
  using Value = S;   // what remains when derivatives are dropped
  static const Value& value(const S& x) { return x; }
  static S pick(bool mask, const S& a, const S& b) { return mask ? a : b; }
  static S at(const float* table, S index) { return S(table[static_cast<int>(index)]); }
  static S power(S x, S e) { return e > S(0) ? (x > S(0) ? S(std::pow(x, e)) : S(0)) : S(1); }
  static S power5(S x, S r) { return r == S(1) ? x * x * x * x * x : power(x, S(5) * r); }
  // The same, with ln x (0 where x is 0), which a derivative needs as well.
  static S power(S x, S e, S& log_x) {
    log_x = x > S(0) ? std::log(x) : S(0);
    return power(x, e);
  }
  static S power5(S x, S r, S& log_x) {
    log_x = x > S(0) ? std::log(x) : S(0);
    return power5(x, r);
  }
};

template <class S>
using Value = typename Arithmetic<S>::Value;

// A literal as S, rounded once to the number inside (float, for a batch or a Jet of floats).
template <Scalar S>
S constant(double x) {
  return S(static_cast<typename Arithmetic<S>::Number>(x));
}

// The smallest number that a denominator or a base may take: the reciprocal of its square is finite.
template <class S>
inline constexpr double kTiny = sizeof(typename Arithmetic<S>::Number) == 4 ? 1e-18 : 1e-150;

// Masks: bool for numbers and Jets, one truth a lane for batches.
template <class A, class B>
auto greater(const A& a, const B& b) {
  return Arithmetic<A>::value(a) > Arithmetic<B>::value(b);
}
template <class M>
M both(const M& a, const M& b) {
  return M(a & b);
}
template <class M>
M either(const M& a, const M& b) {
  return M(a | b);
}
// a where the mask holds, b elsewhere.
template <class M, class S>
S pick(const M& mask, const S& a, const S& b) {
  return Arithmetic<S>::pick(mask, a, b);
}

// table[index] for an index that is a whole number within the table.
template <Scalar S>
S at(const float* table, const S& index) {
  return Arithmetic<S>::at(table, index);
}

// a b + c, rounded once in a batch whose instruction set can: for loops whose time is that of polynomials.
template <Scalar S>
S multiply_add(const S& a, const S& b, const S& c) {
  if constexpr (requires { Arithmetic<S>::multiply_add(a, b, c); }) return Arithmetic<S>::multiply_add(a, b, c);
  else return a * b + c;
}

template <Scalar S>
S larger(const S& a, const S& b) {
  return pick(greater(a, b), a, b);
}
template <Scalar S>
S smaller(const S& a, const S& b) {
  return pick(greater(a, b), b, a);
}
// max(x, 0): the overline of the Callisto slides.
template <Scalar S>
S positive(const S& x) {
  return larger(x, S(0));
}
// x in [0, 1], written t(x) on the Callisto slides.
template <Scalar S>
S clamp01(const S& x) {
  return smaller(positive(x), S(1));
}

// sqrt(x) for x >= 0 with a derivative that stays finite at 0 (there it is 0, not infinity).
template <Scalar S>
S safe_sqrt(const S& x) {
  const auto usable = greater(x, constant<S>(kTiny<S>));
  return pick(usable, S(sqrt(pick(usable, x, S(1)))), S(0));
}

template <Scalar S>
S squared(const S& x) {
  return x * x;
}
// Multiplied from left to right, as power5 does at falloff 1: the two must agree to the last bit.
template <Scalar S>
S fifth_power(const S& x) {
  return x * x * x * x * x;
}

// x^e for x in [0, 1] and e >= 0, with 0^0 = 1, exact at e = 0, and finite derivatives everywhere: the
// falloffs of the Callisto slides, where an exponent of 0 means 'no falloff' also where the cosine is 0.
// At x = 0 the value jumps from 1 to 0 as e leaves 0: that is the definition's, not a rounding.
// x may be the Value of a Jet S, when directions carry no derivative.
template <class X, Scalar S>
S power(const X& x, const S& e) {
  return Arithmetic<S>::power(x, e);
}
// x^(5 r): Schlick's fifth power with a falloff r. At r = 1 it has the bits of fifth_power(x), so that a
// Callisto material at its defaults is Lambert + GGX to the last bit.
template <class X, Scalar S>
S power5(const X& x, const S& r) {
  return Arithmetic<S>::power5(x, r);
}

// Linear interpolation, the slides' lerp (a name that ceres::Jet already takes), exact at both ends:
// a + (b - a) t would leave the rounding of a large `a` in a small `b` at t = 1.
template <Scalar S, class T>
S mix(const S& a, const S& b, const T& t) {
  return a * (T(1) - t) + b * t;
}

}  // namespace likeness::brdf
