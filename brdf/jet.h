#pragma once

#include <ceres/jet.h>

#include "brdf/scalar.h"

// ceres::Jet as a scalar of the evaluators. Needs Eigen and the header ceres/jet.h, not the library.
namespace likeness::brdf {

template <class T, int N>
struct Arithmetic<ceres::Jet<T, N>> {
  using Jet = ceres::Jet<T, N>;
  using Number = typename Arithmetic<T>::Number;
  using Value = T;
  static const T& value(const Jet& x) { return x.a; }

  template <class M>
  static Jet pick(const M& mask, const Jet& a, const Jet& b) {
    if constexpr (std::is_same_v<M, bool>) {
      return mask ? a : b;
    } else {
      Jet out(Arithmetic<T>::pick(mask, a.a, b.a));
      for (int i = 0; i < N; ++i) out.v[i] = Arithmetic<T>::pick(mask, a.v[i], b.v[i]);
      return out;
    }
  }

  static Jet at(const float* table, const Jet& index) { return Jet(Arithmetic<T>::at(table, index.a)); }

  // d(x^e) = x^e ln x de + e x^(e - 1) dx, both taken as 0 where x is 0 (dx would be infinite for e < 1).
  static Jet power(const Jet& x, const Jet& e) { return with_slope(power(x.a, e), e.a, x); }
  static Jet power(const T& x, const Jet& e) {
    T log_x(0.0);
    const T value = Arithmetic<T>::power(x, e.a, log_x);
    return {value, T(value * log_x) * e.v};
  }
  static Jet power5(const Jet& x, const Jet& r) { return with_slope(power5(x.a, r), T(T(5) * r.a), x); }
  static Jet power5(const T& x, const Jet& r) {
    T log_x(0.0);
    const T value = Arithmetic<T>::power5(x, r.a, log_x);
    return {value, T(T(5) * value * log_x) * r.v};
  }

 private:
  static Jet with_slope(Jet raised, const T& e, const Jet& x) {
    const auto usable = x.a > constant<T>(kTiny<Jet>);
    const T slope = brdf::pick(usable, T(e * raised.a / brdf::pick(usable, x.a, T(1))), T(0));
    raised.v += slope * x.v;
    return raised;
  }
};

}  // namespace likeness::brdf
