#pragma once

#include <string>

#include "render/expose/expose.h"

namespace likeness::expose {

// For people, and for programs.
std::string summary_text(const Exposed& exposed);
std::string summary_json(const Exposed& exposed);

// Why the chosen EV is what it is, in a sentence or two; and what of the light is odd (NaN, infinite, no light), one a line.
std::string reason_text(const Exposed& exposed);
std::string oddities_text(const Exposed& exposed);

// "-2.34", and "12.3" of a share, in percent: "0", "<0.01" and "100" only where that is so.
std::string stops_text(double ev);
std::string percent_text(double share);

}  // namespace likeness::expose
