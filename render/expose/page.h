#pragma once

#include <string>

#include "render/expose/expose.h"

namespace likeness::expose {

// One page that shows why the exposure was chosen: histogram under the live curve, every alternative with what it would clip
// and crush, and the first picture with wedge, zones and parts of the curve. Whole in itself.
std::string page_of(const Exposed& exposed);

}  // namespace likeness::expose
