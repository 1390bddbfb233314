#pragma once

#include <limits>

#include "brdf/scalar.h"

namespace likeness::brdf {

// A sum of numbers and products whose rounding errors are kept beside it: two numbers of working precision hold what
// four would, so that n^2 - sin^2 keeps its digits at the critical angle, where its terms cancel to nothing.
//
// Source   Knuth's sum of two numbers and Dekker's product ("A floating-point technique for extending the available
//          precision", 1971), which need no fused multiply-add. Exact unless a product under- or overflows.
// Needs    a compiler that does not reassociate (no -ffast-math). As a Jet the errors have derivative 0.
template <Scalar S>
class ExactSum {
 public:
  ExactSum& add(const S& x) {
    const S total = sum_ + x, part = total - sum_;
    rest_ = rest_ + ((sum_ - (total - part)) + (x - part));
    sum_ = total;
    return *this;
  }
  ExactSum& add_product(const S& a, const S& b) {
    const S product = a * b, a_high = high(a), b_high = high(b), a_low = a - a_high, b_low = b - b_high;
    rest_ = rest_ + (((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low);
    return add(product);
  }
  S value() const { return sum_ + rest_; }

 private:
  // The leading half of x's digits.
  static S high(const S& x) {
    constexpr int kDigits = std::numeric_limits<typename Arithmetic<S>::Number>::digits;
    const S c = x * constant<S>(double((1LL << ((kDigits + 1) / 2)) + 1));
    return c - (c - x);
  }
  S sum_ = S(0.0), rest_ = S(0.0);
};

// sqrt(x) where x > 0, and 0 elsewhere with derivative 0.
template <Scalar S>
S root_or_zero(const S& x) {
  const auto usable = greater(x, S(0));
  return pick(usable, S(sqrt(pick(usable, x, S(1)))), S(0));
}

}  // namespace likeness::brdf
