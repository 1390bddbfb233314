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

  // d(x^e) = x^e ln x de + e x^(e - 1) dx, both taken as 0 where x is 0 (dx would be infinite for e < 1).
  static Jet power(const Jet& x, const Jet& e) { return derived(x, Arithmetic<T>::power(x.a, e.a), e, T(1)); }
  static Jet power(const T& x, const Jet& e) { return derived(x, Arithmetic<T>::power(x, e.a), e, T(1)); }
  static Jet power5(const Jet& x, const Jet& r) { return derived(x, Arithmetic<T>::power5(x.a, r.a), r, T(5)); }
  static Jet power5(const T& x, const Jet& r) { return derived(x, Arithmetic<T>::power5(x, r.a), r, T(5)); }

 private:
  // The Jet of value = x^(times e).
  static Jet derived(const Jet& x, const T& value, const Jet& e, const T& times) {
    const auto usable = x.a > constant<T>(kTiny<Jet>);
    const T base = brdf::pick(usable, x.a, T(1));
    const T in_x = brdf::pick(usable, T(times * e.a * value / base), T(0));
    const T in_e = times * value * log(base);
    return {value, in_x * x.v + in_e * e.v};
  }
  static Jet derived(const T& x, const T& value, const Jet& e, const T& times) {
    const T base = brdf::pick(x > constant<T>(kTiny<Jet>), x, T(1));
    const T in_e = times * value * log(base);
    return {value, in_e * e.v};
  }
};

}  // namespace likeness::brdf
