#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>

#include "brdf/geometry.h"
#include "brdf/parameter.h"

// The one shape in which a row of numbers reaches a model: `likeness eval`, the batched entry points, the stress sweep,
// the cost page and the tables of the docs know the models by this and by nothing else.
//
// An evaluator is a struct without state:
//
//     kName, kText     the name a command takes, and one line of help
//     kOutputs         std::array<Output>: what it returns, in order
//     kFeatures        how many numbers evaluate() reads
//     Forms            std::tuple of the ways to name its inputs; the first is the one that batches take
//     template <Scalar S> static void evaluate(const S* features, S* out);
//
// and a form is a struct with
//
//     kInputs          std::array<Parameter>: what a row names, in order
//     template <Scalar S> static void prepare(const S* in, S* features);
//
// prepare() does what has to be done before numbers are rounded: `likeness eval` runs it in double, and rounds the
// features to the precision that is asked for, so that an angle near 90 degrees loses nothing to float. Whoever starts
// from floats runs it in floats. An evaluator whose features are its inputs derives from Plain<itself> and states
// kInputs.
//
// An evaluator that reads tables declares `struct Tables` and `static const Tables& tables()`, and takes them first:
// evaluate(const Tables&, in, out). tables() is called from baseline code only (brdf/batch.h says why). One that
// cannot be written without branches states `static constexpr bool kOneByOne = true` and is never given batches.
namespace likeness::brdf {

// A column that an evaluator returns.
struct Output {
  std::string_view name;
  std::string_view unit = "1";
  int channels = 1;  // 3: linear RGB
  bool may_be_negative = false;
  std::string_view text;
};

template <std::size_t N>
constexpr std::size_t count_of(const std::array<Parameter, N>& rows) {
  std::size_t count = 0;
  for (const Parameter& row : rows) count += static_cast<std::size_t>(row.channels);
  return count;
}
template <std::size_t N>
constexpr std::size_t count_of(const std::array<Output, N>& rows) {
  std::size_t count = 0;
  for (const Output& row : rows) count += static_cast<std::size_t>(row.channels);
  return count;
}

template <class E>
concept HasTables = requires { typename E::Tables; };
template <class E>
concept OneByOne = requires { requires E::kOneByOne; };

// The form of an evaluator that reads its inputs as they are.
template <class E>
struct Identity {
  static constexpr const auto& kInputs = E::kInputs;
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    for (std::size_t i = 0; i < count_of(kInputs); ++i) features[i] = in[i];
  }
};
template <class E>
struct Plain {
  using Forms = std::tuple<Identity<E>>;
};

// How many numbers evaluate() reads, and how many inputs a form has, with colors counted by channel.
template <class E>
constexpr std::size_t feature_count() {
  if constexpr (requires { E::kFeatures; }) return E::kFeatures;
  else return count_of(E::kInputs);
}
template <class Form>
constexpr std::size_t input_count() {
  return count_of(Form::kInputs);
}
template <class E>
constexpr std::size_t output_count() {
  return count_of(E::kOutputs);
}

// One row from its features. `tables` is the address of E::tables() if E has them.
template <class E, Scalar S>
void evaluate_features(const void* tables, const S* features, S* out) {
  if constexpr (HasTables<E>) E::evaluate(*static_cast<const typename E::Tables*>(tables), features, out);
  else E::evaluate(features, out);
}
// One row from the inputs of a form, all in S.
template <class E, class Form, Scalar S>
void evaluate_inputs(const void* tables, const S* in, S* out) {
  S features[feature_count<E>()];
  Form::prepare(in, features);
  evaluate_features<E>(tables, features, out);
}

// ---- surface models: a pair of directions, then the model's own parameters.

template <std::size_t N, std::size_t K>
constexpr std::array<Parameter, N + K> joined(const std::array<Parameter, N>& a, const std::array<Parameter, K>& b) {
  std::array<Parameter, N + K> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = a[i];
  for (std::size_t i = 0; i < K; ++i) out[N + i] = b[i];
  return out;
}

inline constexpr double kHalfPi = 1.5707963267948966;

// clang-format off
// Unit vectors in the local frame.
struct Vectors {
  static constexpr std::array kInputs{
      Parameter{.name = "light_x", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection,
                .text = "unit vector to the light, local frame: z is the normal"},
      Parameter{.name = "light_y", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its y"},
      Parameter{.name = "light_z", .initial = 1, .range = {-1, 1}, .typical = {0, 1}, .role = Role::kDirection, .text = "its z: cos_i"},
      Parameter{.name = "view_x", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection,
                .text = "unit vector to the viewer, local frame"},
      Parameter{.name = "view_y", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its y"},
      Parameter{.name = "view_z", .initial = 1, .range = {-1, 1}, .typical = {0, 1}, .role = Role::kDirection, .text = "its z: cos_o"},
  };
  template <Scalar S>
  static Geometry<S> pair(const S* in) {
    return Geometry<S>(Vec3<S>(in[0], in[1], in[2]), Vec3<S>(in[3], in[4], in[5]));
  }
};

// Rusinkiewicz's half-angle coordinates.
struct HalfAngles {
  static constexpr std::array kInputs{
      Parameter{.name = "theta_h", .initial = 0, .range = {0, kHalfPi}, .typical = {0, kHalfPi}, .unit = "rad", .role = Role::kAngle,
                .text = "angle between the normal and the half vector"},
      Parameter{.name = "theta_d", .initial = 0, .range = {0, kHalfPi}, .typical = {0, kHalfPi}, .unit = "rad", .role = Role::kAngle,
                .text = "angle between the light and the half vector"},
      Parameter{.name = "phi_d", .initial = kHalfPi, .range = {-2 * kHalfPi, 4 * kHalfPi}, .typical = {0, 2 * kHalfPi}, .unit = "rad",
                .role = Role::kAngle, .text = "azimuth of the light about the half vector; pi/2 is the standard slice"},
  };
  template <Scalar S>
  static Geometry<S> pair(const S* in) {
    return geometry_at<S>(in[0], in[1], in[2]);
  }
};

// Polar angles of light and viewer, and the azimuth between them.
struct PolarAngles {
  static constexpr std::array kInputs{
      Parameter{.name = "theta_i", .initial = 0, .range = {0, kHalfPi}, .typical = {0, kHalfPi}, .unit = "rad", .role = Role::kAngle,
                .text = "angle between the normal and the light"},
      Parameter{.name = "theta_o", .initial = 0, .range = {0, kHalfPi}, .typical = {0, kHalfPi}, .unit = "rad", .role = Role::kAngle,
                .text = "angle between the normal and the viewer"},
      Parameter{.name = "phi", .initial = 0, .range = {-2 * kHalfPi, 4 * kHalfPi}, .typical = {0, 2 * kHalfPi}, .unit = "rad",
                .role = Role::kAngle, .text = "azimuth between them; 0 is the same side, pi the mirror's"},
  };
  template <Scalar S>
  static Geometry<S> pair(const S* in) {
    const S sin_i = sin(in[0]), sin_o = sin(in[1]);
    return Geometry<S>(Vec3<S>(sin_i, S(0), S(cos(in[0]))),
                       Vec3<S>(S(sin_o * cos(in[2])), S(sin_o * sin(in[2])), S(cos(in[1]))));
  }
};
// clang-format on

// Directions in one of the ways above, followed by the parameters of model M.
template <class Directions, class M>
struct Lit {
  static constexpr auto kInputs = joined(Directions::kInputs, M::kParameters);
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    Directions::template pair<S>(in).to_columns(features);
    for (int i = 0; i < channel_count<M>(); ++i)
      features[kGeometryColumns + static_cast<std::size_t>(i)] =
          in[Directions::kInputs.size() + static_cast<std::size_t>(i)];
  }
};

// A surface model as an evaluator.
template <template <class> class M>
struct Surface {
  static constexpr std::string_view kName = M<double>::kName;
  static constexpr std::string_view kText = M<double>::kText;
  static constexpr std::array kOutputs{
      Output{.name = "f", .unit = "1/sr", .channels = 3, .text = "BRDF without the cosine, linear RGB"}};
  static constexpr std::size_t kFeatures = kGeometryColumns + static_cast<std::size_t>(channel_count<M<double>>());
  using Forms = std::tuple<Lit<Vectors, M<double>>, Lit<HalfAngles, M<double>>, Lit<PolarAngles, M<double>>>;
  template <Scalar S>
  static void evaluate(const S* features, S* out) {
    const Rgb<S> f = model_from_channels<M, S>(features + kGeometryColumns).eval(Geometry<S>::from_columns(features));
    out[0] = f.r;
    out[1] = f.g;
    out[2] = f.b;
  }
};

}  // namespace likeness::brdf
