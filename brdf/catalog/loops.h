#pragma once

#include <array>
#include <cstddef>
#include <tuple>

#include "brdf/batch.h"
#include "brdf/catalog/catalog.h"

// The loops over rows, included once for each family and instruction set (CMakeLists.txt makes those files from
// wide.cc.in). Everything here is a template on the batch, whose name carries the set: a plain inline function compiled
// for AVX-512 could replace the baseline's copy when the program is linked.
namespace likeness::catalog {

#ifdef __x86_64__
// SSE2 with multiply-adds that round once, as AVX2 and AVX-512 have them. Polynomials that were rounded twice differ in
// the last bit, and a power as exp(e log x) makes fifty of one; through doubles, three products in a row and all.
struct Baseline : xsimd::sse2 {};
#else
using Baseline = xsimd::default_arch;
#endif

}  // namespace likeness::catalog

#ifdef __x86_64__
namespace xsimd {
namespace types {
XSIMD_DECLARE_SIMD_REGISTER_ALIAS(likeness::catalog::Baseline, sse2);
}

// a b + c of floats: the product is exact in double, so what is left is one rounding to double (which the rounding to
// float hides, but for one case in 2^29) and one to float.
template <class B>
B fused_through_double(const B& a, const B& b, const B& c) {
  const auto low = [](__m128 x) { return _mm_cvtps_pd(x); };
  const auto high = [](__m128 x) { return _mm_cvtps_pd(_mm_movehl_ps(x, x)); };
  const __m128d l = _mm_add_pd(_mm_mul_pd(low(a), low(b)), low(c));
  const __m128d h = _mm_add_pd(_mm_mul_pd(high(a), high(b)), high(c));
  return _mm_movelh_ps(_mm_cvtpd_ps(l), _mm_cvtpd_ps(h));
}

// Specializations of the functions that the library's own polynomials call. Overloads of the kernels below those would be
// declared too late: the library names them with their namespace, which is looked up where it is written.
using FloatBaseline = batch<float, likeness::catalog::Baseline>;
template <>
inline FloatBaseline fma(const FloatBaseline& a, const FloatBaseline& b, const FloatBaseline& c) noexcept {
  return fused_through_double(a, b, c);
}
template <>
inline FloatBaseline fms(const FloatBaseline& a, const FloatBaseline& b, const FloatBaseline& c) noexcept {
  return fused_through_double(a, b, FloatBaseline(-c));
}
template <>
inline FloatBaseline fnma(const FloatBaseline& a, const FloatBaseline& b, const FloatBaseline& c) noexcept {
  return fused_through_double(FloatBaseline(-a), b, c);
}
template <>
inline FloatBaseline fnms(const FloatBaseline& a, const FloatBaseline& b, const FloatBaseline& c) noexcept {
  return fused_through_double(FloatBaseline(-a), b, FloatBaseline(-c));
}

}  // namespace xsimd
#endif

namespace likeness::catalog {

template <class E>
using FirstForm = std::tuple_element_t<0, typename E::Forms>;

// Rows `first` to `first + B::size` of every column. `in` and `out` are sized by the caller.
template <class E, bool kPrepared, class B>
void evaluate_batch(const void* tables, const B* in, B* out) {
  if constexpr (kPrepared) brdf::evaluate_features<E>(tables, in, out);
  else brdf::evaluate_inputs<E, FirstForm<E>>(tables, in, out);
}

template <class E, bool kPrepared, class B>
void batch_loop(const void* tables, const Column<float>* in, float* const* out, std::size_t count) {
  constexpr std::size_t kIn = kPrepared ? brdf::feature_count<E>() : brdf::input_count<FirstForm<E>>();
  constexpr std::size_t kOut = brdf::output_count<E>();
  B row[kIn], result[kOut];
  std::size_t i = 0;
  for (; i + B::size <= count; i += B::size) {
    for (std::size_t k = 0; k < kIn; ++k) row[k] = in[k].constant ? B(*in[k].data) : B::load_unaligned(in[k].data + i);
    evaluate_batch<E, kPrepared>(tables, row, result);
    for (std::size_t k = 0; k < kOut; ++k) result[k].store_unaligned(out[k] + i);
  }
  if (i == count) return;
  // What does not fill a batch: its last row is repeated.
  alignas(64) float lanes[B::size];
  for (std::size_t k = 0; k < kIn; ++k) {
    for (std::size_t lane = 0; lane < B::size; ++lane) {
      const std::size_t row_index = i + lane < count ? i + lane : count - 1;
      lanes[lane] = in[k].data[in[k].constant ? 0 : row_index];
    }
    row[k] = B::load_aligned(lanes);
  }
  evaluate_batch<E, kPrepared>(tables, row, result);
  for (std::size_t k = 0; k < kOut; ++k) {
    result[k].store_aligned(lanes);
    for (std::size_t lane = 0; i + lane < count; ++lane) out[k][i + lane] = lanes[lane];
  }
}

template <class E, bool kPrepared, class N>
void scalar_loop(const void* tables, const Column<N>* in, N* const* out, std::size_t count) {
  constexpr std::size_t kIn = kPrepared ? brdf::feature_count<E>() : brdf::input_count<FirstForm<E>>();
  constexpr std::size_t kOut = brdf::output_count<E>();
  N row[kIn], result[kOut];
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < kIn; ++k) row[k] = in[k].data[in[k].constant ? 0 : i];
    if constexpr (kPrepared) brdf::evaluate_features<E>(tables, row, result);
    else brdf::evaluate_inputs<E, FirstForm<E>>(tables, row, result);
    for (std::size_t k = 0; k < kOut; ++k) out[k][i] = result[k];
  }
}

template <class E, class B>
Loops<float> batch_loops_of() {
  if constexpr (brdf::OneByOne<E>) return {};
  else return {&batch_loop<E, true, B>, &batch_loop<E, false, B>};
}

// The loops of every evaluator of a family, in order; written to `out`, which has one entry for each.
template <class Evaluators, class B>
void batch_loops(Loops<float>* out) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    ((out[I] = batch_loops_of<std::tuple_element_t<I, Evaluators>, B>()), ...);
  }(std::make_index_sequence<std::tuple_size_v<Evaluators>>{});
}

}  // namespace likeness::catalog
