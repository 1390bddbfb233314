#pragma once

#include <string>

#include "render/photograph/merge.h"

// What `likeness hdr merge` says about a merged bracket: as text, as JSON and as a page.
namespace likeness::olat_photograph {

std::string text_of(const photograph::Merged& merged);
std::string json_of(const photograph::Merged& merged);
std::string page_of(const photograph::Merged& merged);

// The EV at which the page shows the picture: the 90th percentile of luminance at 0.5.
double sensible_ev(const photograph::Merged& merged);

}  // namespace likeness::olat_photograph
