#pragma once

#include <xsimd/xsimd.hpp>

#include "brdf/scalar.h"

// xsimd::batch as a scalar of the evaluators, and of ceres::Jet (together with brdf/jet.h). The width is
// that of the instruction set the including file is compiled for; a file compiled for more than the
// baseline must hold nothing but functions templated on the batch, because a plain inline function
// would replace the baseline's copy when the program is linked.
namespace likeness::brdf {

template <class T, class A>
struct Arithmetic<xsimd::batch<T, A>> {
  using Batch = xsimd::batch<T, A>;
  using Number = T;
  using Value = Batch;
  static const Batch& value(const Batch& x) { return x; }
  static Batch pick(const xsimd::batch_bool<T, A>& mask, const Batch& a, const Batch& b) {
    return xsimd::select(mask, a, b);
  }
  static Batch multiply_add(const Batch& a, const Batch& b, const Batch& c) { return xsimd::fma(a, b, c); }
  static Batch at(const float* table, const Batch& index) {
    alignas(64) T lanes[Batch::size];
    index.store_aligned(lanes);
    for (std::size_t i = 0; i < Batch::size; ++i) lanes[i] = T(table[static_cast<int>(lanes[i])]);
    return Batch::load_aligned(lanes);
  }
  static Batch power(const Batch& x, const Batch& e) {
    Batch log_x;
    return power(x, e, log_x);
  }
  static Batch power5(const Batch& x, const Batch& r) {
    Batch log_x;
    return power5(x, r, log_x);
  }
  // The same, with ln x (0 where x is 0), which a derivative needs as well.
  static Batch power(const Batch& x, const Batch& e, Batch& log_x) {
    const auto usable = x > Batch(T(0));
    log_x = xsimd::log(xsimd::select(usable, x, Batch(T(1))));
    const Batch raised = xsimd::exp(e * log_x);
    return xsimd::select(e > Batch(T(0)), xsimd::select(usable, raised, Batch(T(0))), Batch(T(1)));
  }
  static Batch power5(const Batch& x, const Batch& r, Batch& log_x) {
    const Batch raised = power(x, Batch(T(5)) * r, log_x);
    return xsimd::select(r == Batch(T(1)), x * x * x * x * x, raised);
  }
};

}  // namespace likeness::brdf

namespace Eigen {
template <class T>
struct NumTraits;
template <class T>
struct GenericNumTraits;
// Lets ceres::Jet hold a batch: Eigen asks for the traits of whatever an array is made of.
template <class T, class A>
struct NumTraits<xsimd::batch<T, A>> : GenericNumTraits<T> {
  using Real = xsimd::batch<T, A>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = Real;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
};
}  // namespace Eigen
