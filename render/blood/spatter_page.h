#pragma once

#include <string>

#include "render/blood/raster.h"

namespace likeness::blood {

std::string summary_of(const SpatterOptions& options, const Spatter& spatter, const Decal& decal);
// Every drop; the page has the pictures and the relations.
std::string json_of(const SpatterOptions& options, const Spatter& spatter, const Decal& decal);
std::string page_of(const SpatterOptions& options, const Spatter& spatter, const Decal& decal,
                    const image::Picture& preview);

}  // namespace likeness::blood
