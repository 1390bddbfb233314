#pragma once

#include <filesystem>
#include <optional>

#include "brdf/callisto.h"
#include "render/baked/bake_file.h"
#include "render/image/picture.h"

// Thin copies of what a bake's renders were made of, beside it: whoever has them renders the subject under any light, and
// sees by them where a surface was changed since (spec: Realis, Bake, 5).
//
//     normal.png       8 bit: (b - 128) / 127, then made unit; (128, 128, 128): none
//     base_color.png   8 bit, sRGB curve, of base_color / scale
//     surface.json     scale, exposure, spread, least
//     surface.material.json
namespace likeness::baked {

struct Surface {
  image::Picture normals;      // unit; (0, 0, 0): not known
  image::Picture base_colors;  // linear, >= 0
  brdf::Callisto<double> material;
  double exposure = 1;  // photo over what the material returns of a unit light
  // How cosines are spread within a pixel, and the least light, over what the diffuse part returns of a light that it faces
  // (capture_fit::Fit).
  double spread = 0, least = 0;
};

// The surface's two pictures as they are stored.
struct ThinSurface {
  image::DisplayPicture normals, colors;
  double scale = 0;  // base color that 255 stands for
};
ThinSurface packed(const Surface& surface);

// The surface as 8 bits hold it. What is rendered from it is rendered again, to the bit, from what write_surface() wrote:
// bake against that, and nothing is lost by the thinness of the copies.
Surface thin(const Surface& surface);

void write_surface(const std::filesystem::path& folder, const Surface& surface);
// Throws files::InputError.
Surface read_surface(const std::filesystem::path& folder, const Access& access = from_files());

}  // namespace likeness::baked
