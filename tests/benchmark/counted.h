#pragma once

#include <cmath>
#include <cstdint>

#include "brdf/scalar.h"

// A scalar that counts what is done with it, so that a model's arithmetic can be priced: one operation of a batch for
// each of a plain scalar's. Powers are counted as batches compute them (brdf/batch.h): a logarithm, an exponential, and
// what guards them.
namespace likeness::brdf {

struct Counts {
  std::uint64_t basic = 0;  // additions, multiplications, comparisons, choices: one slot of the multiply-add units
  std::uint64_t divisions = 0, roots = 0, exponentials = 0, logarithms = 0;
};

struct Counted {
  double x = 0;
  static inline Counts counts{};

  Counted() = default;
  explicit Counted(double x_) : x(x_) {}
  Counted operator-() const { return basic(-x); }
  friend Counted operator+(Counted a, Counted b) { return basic(a.x + b.x); }
  friend Counted operator-(Counted a, Counted b) { return basic(a.x - b.x); }
  friend Counted operator*(Counted a, Counted b) { return basic(a.x * b.x); }
  friend Counted operator/(Counted a, Counted b) {
    ++counts.divisions;
    return Counted(a.x / b.x);
  }
  friend bool operator>(Counted a, Counted b) {
    ++counts.basic;
    return a.x > b.x;
  }
  friend Counted sqrt(Counted a) {
    ++counts.roots;
    return Counted(std::sqrt(a.x));
  }
  friend Counted exp(Counted a) {
    ++counts.exponentials;
    return Counted(std::exp(a.x));
  }
  friend Counted log(Counted a) {
    ++counts.logarithms;
    return Counted(std::log(a.x));
  }
  static Counted basic(double x) {
    ++counts.basic;
    return Counted(x);
  }
};

template <>
struct Arithmetic<Counted> {
  using Number = float;
  using Value = Counted;
  static const Counted& value(const Counted& a) { return a; }
  static Counted pick(bool mask, const Counted& a, const Counted& b) { return Counted::basic(mask ? a.x : b.x); }
  static Counted power(const Counted& a, const Counted& e) {
    const bool usable = a > Counted(0), rising = e > Counted(0);
    const Counted raised = exp(e * log(pick(usable, a, Counted(1))));
    return pick(rising, pick(usable, raised, Counted(0)), Counted(1));
  }
  static Counted power5(const Counted& a, const Counted& r) {
    const Counted raised = power(a, Counted(5) * r);
    const bool plain = r > Counted(1);  // the batch compares for equality, at the same price
    return pick(plain, a * a * a * a * a, raised);
  }
};

}  // namespace likeness::brdf
