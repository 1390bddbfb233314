#pragma once

#include <string>

#include "render/expose/expose.h"

namespace likeness::expose {

// The light of the series in stops, after the chosen exposure, under the live curve: bars a quarter stop wide, zones above
// them, toe and shoulder shaded, and where codes 0 and 255 begin. Inline SVG.
std::string plot_of(const Exposed& exposed);

}  // namespace likeness::expose
