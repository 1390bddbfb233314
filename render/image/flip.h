#pragma once

#include <cstddef>
#include <vector>

#include "render/image/picture.h"

// FLIP: the difference that an observer sees who alternates between two pictures, 0 (none) to 1, for each pixel.
//
// Source      Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild, "FLIP: A Difference Evaluator for
//             Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020, with its erratum (division by
//             116); HDR: Andersson, Nilsson, Shirley and Akenine-Moller, "Visualizing Errors in Rendered High Dynamic
//             Range Images", Eurographics 2021 short papers. A single number is the mean, as the authors advise.
// Holds       identical: 0; symmetric in the two pictures (LDR); green and blue, the farthest colors: 1; flat black and
//             white: 0.9674.
// Departures  the filters are separated (a sum of Gaussians, Fourier pairs of the contrast sensitivity), not
//             approximated; the exposures of hdr_flip() are those of lit pixels (below).
namespace likeness::image {

struct ErrorMap {
  int width = 0, height = 0;
  std::vector<float> error;  // row by row from the top left
  double mean = 0;
};

struct FlipOptions {
  // Of the observer's visual angle; the paper's screen of 0.7 m and 3840 pixels at 0.7 m. In [1, 1000].
  double pixels_per_degree = 67.020643276582255;
};

// Both pictures have the same size, and the options are in their range, else std::invalid_argument. Rows are shared
// among TBB's threads; the result does not depend on their number.
ErrorMap flip(const DisplayPicture& reference, const DisplayPicture& render, const FlipOptions& options = {});

struct HdrErrorMap : ErrorMap {
  double start_ev = 0, stop_ev = 0;  // of the exposures [stops]
  int exposures = 0;
  std::size_t not_finite = 0;  // values of both pictures, taken as black (NaN) or as the largest float
};

// The largest FLIP over exposures of linear light one stop apart, each mapped by the ACES curve of Narkowicz: from that
// which puts the reference's largest luminance at 0.85 of white to that which puts its median there. The paper's median
// of a mostly black reference is 0 and its exposure infinite: the median is that of the pixels which are lit, and at
// least 2^-24 of the largest. A black reference has the one exposure 0.
HdrErrorMap hdr_flip(const Picture& reference, const Picture& render, const FlipOptions& options = {});

// The same over stated exposures, so that errors of several pairs can be compared: from first_ev to last_ev, at most one
// stop apart. Finite, first_ev <= last_ev, at most 64 stops apart, else std::invalid_argument.
struct Exposures {
  double first_ev = 0, last_ev = 0;
};
HdrErrorMap hdr_flip_over(const Exposures& exposures, const Picture& reference, const Picture& render,
                          const FlipOptions& options = {});

// A map for the eye: black, violet, orange, pale yellow (the magma map, as in the paper). Values outside [0, 1] are
// clamped, NaN is 0.
DisplayPicture error_picture(const ErrorMap& map);

}  // namespace likeness::image
