#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "brdf/any_brdf.h"
#include "fit/measured/measured.h"

namespace likeness::datasets_synthetic {

// The points that a file stores: bins[0] x bins[1] x bins[2] cells, the last index running fastest.
//   MERL         theta_h x theta_d x phi_d, always 90 x 90 x 180; cell centers theta_h = 90 deg ((i + .5) / 90)^2,
//                theta_d = j + .5 deg, phi_d = k + .5 deg
//   mbsdf, CSV   theta_i x theta_o x phi over 90 x 90 x 180 deg in equal steps; phi is the azimuth between light
//                and viewer, 180 deg at the mirror direction
struct Grid {
  measured::Format format = measured::Format::kMerl;  // RGL is not written
  std::array<int, 3> bins{90, 90, 180};
  double within = 0.5;  // where in its cell a sample is taken: 0.5 the center, as readers expect; 0 the lower edge

  std::size_t size() const { return std::size_t(bins[0]) * std::size_t(bins[1]) * std::size_t(bins[2]); }
};

// The grid of a format; theta and phi are the numbers of bins of the formats that have a choice.
Grid grid_of(measured::Format format, int theta, int phi);

// The directions of one cell.
brdf::Geometry<double> geometry_of(const Grid& grid, int i, int j, int k);

enum class State : std::uint8_t {
  kBelowHorizon,  // light or viewer is below the surface: no material has a value there
  kMeasured,
  kInvalid,    // the format's mark of 'not measured': -1, or in a CSV no row at all
  kNotFinite,  // a channel is NaN
  kNegative,   // a channel has been made negative
};

// What a file holds, before it is written.
struct Table {
  Grid grid;
  std::array<std::vector<double>, 3> f;  // red, green, blue [1/sr]; 0 below the horizon
  std::vector<State> state;
};

// The model at every cell of the grid. Uses `threads` threads (0: one a core); the result does not depend on it.
Table tabulate(const brdf::AnyBrdf& brdf, const Grid& grid, int threads = 0);

// The bytes of the file, in the grid's format.
std::string bytes_of(const Table& table);

}  // namespace likeness::datasets_synthetic
