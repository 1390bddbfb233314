#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "brdf/any_brdf.h"

// One evaluation of a model in any kind of scalar, from a model and directions given in double.
namespace likeness::brdf {

using Channels = std::array<double, 3>;

// The plain number of the first lane, without its derivative. Batches and Jets add their own.
template <class S>
struct First {
  static double of(const S& x) { return double(x); }
};
template <class S>
double first(const S& x) {
  return First<S>::of(x);
}

template <Scalar S, template <class> class M>
M<S> model_in(const M<double>& model) {
  const auto from = channels_of(model);
  std::array<S, channel_count<M<S>>()> to;
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = constant<S>(from[i]);
  return model_from_channels<M, S>(to.data());
}

template <Scalar S>
Vec3<S> vector_in(const Vec3<double>& v) {
  return {constant<S>(v.x), constant<S>(v.y), constant<S>(v.z)};
}

// A pair computed in double and rounded, as the renderers and the fit do it.
template <Scalar S>
Geometry<S> geometry_in(const Geometry<double>& g) {
  using Number = typename Arithmetic<S>::Number;
  if constexpr (std::is_same_v<S, Number>) {
    return Geometry<S>(g);
  } else {
    return Geometry<S>(Geometry<Number>(g));
  }
}

template <Scalar S>
Channels channels(const Rgb<S>& f) {
  return {first(f.r), first(f.g), first(f.b)};
}

// f of directions that are rounded to S before anything else.
template <Scalar S, template <class> class M>
Channels eval_in(const M<double>& model, const Vec3<double>& to_light, const Vec3<double>& to_view) {
  return channels(
      model_in<S>(model).eval(Geometry<Value<S>>(vector_in<Value<S>>(to_light), vector_in<Value<S>>(to_view))));
}
// f of half-angle quantities that are rounded to S.
template <Scalar S, template <class> class M>
Channels eval_in(const M<double>& model, const Geometry<double>& g) {
  return channels(model_in<S>(model).eval(geometry_in<Value<S>>(g)));
}

inline bool finite_and_not_negative(const Channels& f) {
  for (const double x : f)
    if (!std::isfinite(x) || x < 0) return false;
  return true;
}

inline double relative_difference(double got, double want, double zero = 1e-15) {
  const double difference = std::abs(got - want);
  return difference <= zero ? 0 : difference / std::max(std::abs(got), std::abs(want));
}

// The same numbers on every machine and standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low = 0, double high = 1) { return low + (high - low) * double(engine_() >> 11) * 0x1p-53; }
  std::size_t index(std::size_t count) { return std::size_t(uniform() * double(count)); }
  Vec3<double> direction(double cos_low = 0, double cos_high = 1) {
    return direction_at(uniform(cos_low, cos_high), uniform(0, 2 * std::numbers::pi));
  }
  static Vec3<double> direction_at(double z, double phi) {
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937_64 engine_;
};

// Every parameter drawn from `interval(row)`.
template <class M, class F>
M random_model(Random& random, F&& interval) {
  M model;
  for_each_parameter(model, [&]<class V>(const Parameter& row, V& value) {
    const Interval in = interval(row);
    if constexpr (std::is_same_v<V, double>) {
      value = random.uniform(in.low, in.high);
    } else {
      value = V{random.uniform(in.low, in.high), random.uniform(in.low, in.high), random.uniform(in.low, in.high)};
    }
  });
  return model;
}

}  // namespace likeness::brdf
