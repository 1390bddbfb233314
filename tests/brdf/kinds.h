#pragma once

#include <gtest/gtest.h>

#include "brdf/batch.h"
#include "tests/brdf/evaluate.h"

// The scalars without derivatives that every hard case is run in.
namespace likeness::brdf {

template <class T, class A>
struct First<xsimd::batch<T, A>> {
  static double of(const xsimd::batch<T, A>& x) { return double(x.get(0)); }
};

using Kinds = ::testing::Types<double, float, xsimd::batch<double>, xsimd::batch<float>>;

struct KindNames {
  template <class S>
  static std::string GetName(int) {
    const bool wide = !std::is_same_v<S, typename Arithmetic<S>::Number>;
    return std::string(wide ? "BatchOf" : "") + (kIsFloat<S> ? "Float" : "Double");
  }
  template <class S>
  static constexpr bool kIsFloat = std::is_same_v<typename Arithmetic<S>::Number, float>;
};

// The models of AnyBrdf, for a suite typed over them.
template <class V>
struct TypesOf;
template <class... M>
struct TypesOf<std::variant<M...>> {
  using Type = ::testing::Types<M...>;
};
struct ModelNames {
  template <class M>
  static std::string GetName(int) {
    return std::string(M::kName);
  }
};

template <class S>
inline constexpr bool kIsFloat = std::is_same_v<typename Arithmetic<S>::Number, float>;

}  // namespace likeness::brdf
