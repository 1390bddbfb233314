#pragma once

#include <filesystem>

#include "fit/capture/capture_fit.h"
#include "realis/subject.h"

// Thin copies of what a bake's renders were made of, beside it: whoever has them renders the subject under any light, and
// sees by them where a surface was changed since (spec: Realis, Bake, 5).
//
//     normal.png       8 bit: (b - 128) / 127, then made unit; (128, 128, 128): none
//     base_color.png   8 bit, sRGB curve, of base_color / scale
//     surface.json     scale, exposure
//     surface.material.json
namespace likeness::realis {

// The fit as 8 bits hold it. What is rendered from it is rendered again, to the bit, from what write_surface() wrote:
// bake against that, and nothing is lost by the thinness of the copies.
capture_fit::Fit thin(const capture_fit::Fit& fit);

void write_surface(const std::filesystem::path& folder, const capture_fit::Fit& fit);
// Normals, base colors, material and exposure. Throws files::InputError.
capture_fit::Fit read_surface(const std::filesystem::path& folder, std::size_t camera);

}  // namespace likeness::realis
