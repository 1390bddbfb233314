#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "brdf/any_brdf.h"
#include "fit/measured/measured.h"
#include "render/image/picture.h"

// A slice of a BRDF as a picture: phi_d fixed, theta_h from 0 to 90 deg to the right, theta_d from 0 to 90 deg up,
// sampled at the centres of equal bins. The standard slice has phi_d = 90 deg and 90 x 90 bins of one degree; there
// cos_i = cos_o = cos theta_h cos theta_d.
namespace likeness::fit {

inline constexpr int kSliceSize = 90;

struct SliceGrid {
  int size = kSliceSize;              // bins along either side
  double phi_d = 1.5707963267948966;  // [rad]
};

// Angles of a column and a row of a slice's picture [deg]; row 0 is the top.
constexpr double slice_theta_h_deg(int column, int size = kSliceSize) { return (column + 0.5) * (90.0 / size); }
constexpr double slice_theta_d_deg(int row, int size = kSliceSize) { return (size - row - 0.5) * (90.0 / size); }

struct SlicePicture {
  image::Picture f;                 // [1/sr], linear RGB, cosine not included; 0 where not valid
  std::vector<std::uint8_t> valid;  // 0 or 1, row by row

  explicit SlicePicture(int size = kSliceSize) : f(size, size), valid(std::size_t(size) * std::size_t(size)) {}
  int size() const { return f.width; }
  std::size_t index(int column, int row) const { return std::size_t(row) * std::size_t(size()) + std::size_t(column); }
  bool valid_at(int column, int row) const { return valid[index(column, row)] != 0; }
};

SlicePicture slice_of(const measured::Material& material, const SliceGrid& grid = {});
SlicePicture slice_of(const brdf::AnyBrdf& model, const SliceGrid& grid = {});

// True where theta_i and theta_o of the standard slice's pixel are at most the cut.
bool within_cut(int column, int row, double cut_deg, int size = kSliceSize);

// log2(model / reference) of Rec. 709 luminance, in stops: above 0 where the model is brighter. Values below
// kDarkest [1/sr] count as kDarkest. NaN where the reference is not valid or the pixel lies beyond the cut.
inline constexpr double kDarkest = 1e-4;
using Stops = std::vector<float>;  // row by row, as many as either slice has pixels
Stops difference_in_stops(const SlicePicture& reference, const SlicePicture& model, double cut_deg);

// Half of the compared pixels differ by at most this [stops], whatever the sign; NaN if none is compared.
double median_difference(const Stops& stops);

// The diverging scale of signed differences, held at its ends beyond +-kStopsRange: blue for darker, near white for
// equal, orange-brown for brighter (ColorBrewer's PuOr with its violet side turned to blue, so that the common
// colour blindnesses keep the two sides apart). 8-bit sRGB.
inline constexpr double kStopsRange = 2;
using Color8 = std::array<std::uint8_t, 3>;
Color8 difference_color(double stops);

// Hatched in grey: pixels for which there is nothing to show.
Color8 no_data_color(int column, int row);

image::DisplayPicture difference_picture(const Stops& stops);
image::DisplayPicture slice_picture(const SlicePicture& slice, double ev);

// The exposure [EV, whole stops within -4..6] that brings the median luminance of the valid pixels within the cut
// nearest to 0.18.
double slice_exposure(const SlicePicture& reference, double cut_deg);

// Rec. 709 luminance of linear RGB.
inline double luminance(double r, double g, double b) { return 0.2126 * r + 0.7152 * g + 0.0722 * b; }

// The exposure in whole stops, within -4..highest_ev, that brings the median of these luminances nearest to `target`.
double exposure_of_median(std::vector<double> luminances, double target, double highest_ev);

}  // namespace likeness::fit
