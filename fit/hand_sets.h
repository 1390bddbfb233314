#pragma once

#include <optional>
#include <string_view>

#include "brdf/any_brdf.h"

namespace likeness::fit {

// What the talk's authors set by hand for ten MERL materials (Jimenez and Petersen, "The Rendering of The Callisto
// Protocol", SIGGRAPH 2023, slides 'BRDF slice selection'): the yardstick of a fit.
struct HandSet {
  brdf::Callisto<double> callisto;
  brdf::Disney2012<double> disney;  // the slides' 'Burley'
};

// The hand set of a material by its MERL name (light-red-paint); hyphens, spaces and case do not count.
std::optional<HandSet> hand_set_of(std::string_view material);

}  // namespace likeness::fit
