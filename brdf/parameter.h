#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>

#include "brdf/vector.h"

namespace likeness::brdf {

struct Interval {
  double low = 0, high = 1;
};

// What a parameter does, which decides how a fit treats it.
enum class Role {
  kScale,  // a reflectance or an intensity that multiplies a term
  kTint,   // a color in [0, 1] that multiplies the scale named by `tints`
  kShape,  // a roughness, a falloff, a length: enters non-linearly
  kMix,    // a weight between two terms
  // Of inputs that are no parameters of a material:
  kDirection,  // a component of a unit vector: x, y and z follow one another
  kAngle,      // an angle or an azimuth
  kCoordinate  // a position, a random number, a wavelength
};

// The smallest set of parameters in which this one is exposed (Callisto slides, 'parameters'). A fit of
// a tier leaves what the tier does not expose at its default; other models are all kPlain.
enum class Tier { kPlain, kBase, kAdvanced, kFull };
inline constexpr std::array<std::string_view, 4> kTierNames{"plain", "base", "advanced", "full"};

// One row of a model's table: the only statement of a parameter's name, order, default, bounds and
// unit. Bounds of the fit, --help, the material file and the docs are made from it.
struct Parameter {
  std::string_view name;
  double initial = 0;  // default, of every channel
  Interval range;      // what is allowed
  Interval typical;    // what is usual; starts of a fit are drawn from it
  std::string_view unit = "1";
  Role role = Role::kShape;
  Tier tier = Tier::kPlain;
  int channels = 1;  // 3: linear RGB
  std::string_view tints = {};
  bool logarithmic = false;  // drawn and plotted by its logarithm
  std::string_view text;     // one line for help and docs
};

void no_such_parameter();  // not constexpr and nowhere defined: what calls it while compiling does not compile

// The default of a parameter by name; a name that is not in the table does not compile.
template <std::size_t N>
consteval double initial(const std::array<Parameter, N>& table, std::string_view name) {
  for (const Parameter& row : table)
    if (row.name == name) return row.initial;
  no_such_parameter();
  return 0;
}

// A model is a struct with kName, kParameters and members(), a tuple of pointers to the fields in the
// order of the table. The functions below are all that other rooms know of its fields.
template <class M>
constexpr int channel_count() {
  int count = 0;
  for (const Parameter& row : M::kParameters) count += row.channels;
  return count;
}

// Calls visit(row, first, channel references...) for every parameter: once with S&, or with Rgb<S>&.
template <class M, class F>
void for_each_parameter(M& model, F&& visit) {
  using Model = std::remove_const_t<M>;
  constexpr auto kMembers = Model::members();
  static_assert(std::tuple_size_v<decltype(kMembers)> == Model::kParameters.size());
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (visit(Model::kParameters[I], model.*std::get<I>(kMembers)), ...);
  }(std::make_index_sequence<std::tuple_size_v<decltype(kMembers)>>{});
}

// All channels of all parameters, in table order.
template <template <class> class M, Scalar S>
std::array<S, channel_count<M<S>>()> channels_of(const M<S>& model) {
  std::array<S, channel_count<M<S>>()> out;
  std::size_t at = 0;
  for_each_parameter(model, [&]<class V>(const Parameter&, const V& value) {
    if constexpr (std::is_same_v<V, Rgb<S>>) {
      out[at++] = value.r;
      out[at++] = value.g;
      out[at++] = value.b;
    } else {
      out[at++] = value;
    }
  });
  return out;
}

// The inverse of channels_of; `values` has channel_count<M<S>>() entries.
template <template <class> class M, Scalar S>
M<S> model_from_channels(const S* values) {
  M<S> model;
  for_each_parameter(model, [&]<class V>(const Parameter&, V& value) {
    if constexpr (std::is_same_v<V, Rgb<S>>) {
      value = V{values[0], values[1], values[2]};
      values += 3;
    } else {
      value = *values++;
    }
  });
  return model;
}

}  // namespace likeness::brdf
