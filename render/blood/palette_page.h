#pragma once

#include <string>

#include "render/blood/palette_fit.h"

namespace likeness::blood {

std::string summary_of(const Table& table, const PaletteFit& fit);
std::string json_of(const Table& table, const PaletteFit& fit);
std::string page_of(const Table& table, const PaletteFit& fit);

}  // namespace likeness::blood
