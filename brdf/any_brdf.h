#pragma once

#include <array>
#include <variant>

#include "brdf/burley_diffuse.h"
#include "brdf/callisto.h"
#include "brdf/disney2012.h"
#include "brdf/ggx.h"
#include "brdf/lambert.h"

namespace likeness::brdf {

// Every surface model that a file or a command can name; std::visit is the dispatch. A model added here
// gains its tests (every_model_test), its material file, its fit and its page in the docs.
using AnyBrdf = std::variant<Callisto<double>, Disney2012<double>, Ggx<double>, Lambert<double>, BurleyDiffuse<double>>;

inline constexpr std::array kModelNames{Callisto<double>::kName, Disney2012<double>::kName, Ggx<double>::kName,
                                        Lambert<double>::kName, BurleyDiffuse<double>::kName};

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
