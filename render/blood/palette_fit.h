#pragma once

#include <array>
#include <vector>

#include "brdf/blood/palette.h"
#include "render/blood/table.h"
#include "render/image/picture.h"

namespace likeness::blood {

struct PaletteFit {
  brdf::BloodPalette<double> palette;
  double smoothness = 0;  // of the spline; infinity: none is used
  // Delta E 2000 of each cell: of the spectra alone, of the palette, and of a palette that was fitted without the cell.
  std::vector<double> spectral, fitted, held_out;
};

// The palette of a table of 12 cells or more at two opacities and two times or more. First the spectra by least squares of
// encoded (sRGB) values, then the spline through what is left of the logarithms, as smooth as foretells cells best that were
// left out (by the closed form of leaving each one out; none if none does). held_out: each fifth cell in turn, all fitted
// anew. Throws std::invalid_argument for fewer.
PaletteFit fit_palette(const Table& table);

std::array<double, 3> color_of(const brdf::BloodPalette<double>& palette, double opacity, double time);
double difference(const std::array<double, 3>& a, const std::array<double, 3>& b);  // Delta E 2000 of linear colors

// Opacity to the right from 0 to 1, time downwards from 0 to the palette's longest, in its own coordinate.
image::Picture picture_of(const brdf::BloodPalette<double>& palette, int width, int height);

}  // namespace likeness::blood
