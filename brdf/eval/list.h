#pragma once

#include <span>
#include <string>

#include "brdf/catalog/catalog.h"

// What there is to evaluate, for people and for programs.
namespace likeness::eval {

// Each evaluator with the inputs of every form (range, usual range, default, unit, text) and its outputs.
std::string list_text(std::span<const catalog::Entry> entries);

// The same as a JSON array.
std::string list_json(std::span<const catalog::Entry> entries);

// The entry of that name. Throws files::UsageError that names the nearest.
const catalog::Entry& entry_named(std::string_view name);

}  // namespace likeness::eval
