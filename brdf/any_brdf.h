#pragma once

#include <array>
#include <variant>

#include "brdf/burley_diffuse.h"
#include "brdf/callisto.h"
#include "brdf/callisto_proxima.h"
#include "brdf/disney2012.h"
#include "brdf/ggx.h"
#include "brdf/lambert.h"
#include "brdf/oren_nayar.h"
#include "brdf/proxima.h"

namespace likeness::brdf {

// Every surface model that a file or a command can name; std::visit is the dispatch. A model added here
// gains its tests (every_model_test), its material file, its fit and its page in the docs.
using AnyBrdf = std::variant<Callisto<double>, Disney2012<double>, Ggx<double>, Lambert<double>, BurleyDiffuse<double>,
                             OrenNayar<double>, OrenNayar1994<double>, Proxima<double>, CallistoProxima<double>>;

inline constexpr std::array kModelNames{
    Callisto<double>::kName,      Disney2012<double>::kName,    Ggx<double>::kName,
    Lambert<double>::kName,       BurleyDiffuse<double>::kName, OrenNayar<double>::kName,
    OrenNayar1994<double>::kName, Proxima<double>::kName,       CallistoProxima<double>::kName};
static_assert(kModelNames.size() == std::variant_size_v<AnyBrdf>);

// Whether `likeness fit` finds the parameters of a model: of all but those that state kFitted = false.
template <class M>
inline constexpr bool kFitted = true;
template <class M>
  requires requires { M::kFitted; }
inline constexpr bool kFitted<M> = M::kFitted;

// The same by index in AnyBrdf.
inline constexpr auto kFittedModels = []<std::size_t... I>(std::index_sequence<I...>) {
  return std::array{kFitted<std::variant_alternative_t<I, AnyBrdf>>...};
}(std::make_index_sequence<std::variant_size_v<AnyBrdf>>{});

// The model of that name at its defaults; false if there is none.
inline bool model_of_name(std::string_view name, AnyBrdf& out) {
  const auto matches = [&]<class M>(M model) {
    if (M::kName != name) return false;
    out = model;
    return true;
  };
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return (matches(std::variant_alternative_t<I, AnyBrdf>{}) || ...);
  }(std::make_index_sequence<std::variant_size_v<AnyBrdf>>{});
}

}  // namespace likeness::brdf
