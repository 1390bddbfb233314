#pragma once

#include <filesystem>

#include "fit/capture/capture_fit.h"
#include "realis/subject.h"

// A fit as the property maps of a bake hold it (render/baked/surface_maps.h).
namespace likeness::realis {

// The fit as 8 bits hold it. What is rendered from it is rendered again, to the bit, from what write_surface() wrote:
// bake against that, and nothing is lost by the thinness of the copies.
capture_fit::Fit thin(const capture_fit::Fit& fit);

void write_surface(const std::filesystem::path& folder, const capture_fit::Fit& fit);
// Normals, base colors, material and exposure. Throws files::InputError.
capture_fit::Fit read_surface(const std::filesystem::path& folder, std::size_t camera);

}  // namespace likeness::realis
