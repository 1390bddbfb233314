#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/any_brdf.h"
#include "render/files/files.h"

// The parameter table of a model that is chosen at run time: what a file and a command line need of it.
namespace likeness::material {

// One row and what the model holds there: value[0] alone, or red, green, blue if the row has 3 channels.
struct Entry {
  brdf::Parameter row;
  std::array<double, 3> value{};
};

std::string_view model_name(const brdf::AnyBrdf& brdf);

// Every parameter of the model, in table order.
std::vector<Entry> entries(const brdf::AnyBrdf& brdf);

// Gives one parameter new channels. Returns an empty string, or what is wrong, starting with the parameter
// ("roughness = 1.2 is outside [0, 1] (of the sharper lobe; ...)"), and then changes nothing. A caller puts the
// place before it: the file and its line, or the option.
std::string assign(brdf::AnyBrdf& brdf, std::string_view name, std::span<const double> channels);

// The first parameter outside its range, as assign would say it; empty if all are inside.
std::string complaint(const brdf::AnyBrdf& brdf);

// `no model "calisto"; did you mean "callisto"? (models: callisto, ...)`: what to say of an unknown model.
std::string no_such_model(std::string_view name);

using files::in_quotes;
using files::number_text;

}  // namespace likeness::material
