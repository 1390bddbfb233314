#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "fit/measured/measured.h"

namespace likeness::measured {

// NVIDIA .mbsdf, the reflection part. Source: NVIDIA Material Definition Language specification, appendix 'MBSDF file
// format': "NVIDIA ARC MBSDF V1\n", lines of text, "MBSDF_DATA=\n" or "MBSDF_DATA_REFLECTION=\n", then uint32 type
// (0 scalar, 1 RGB), uint32 resolution of theta, uint32 of phi, and float32 [theta_in][theta_out][phi][channel];
// "MBSDF_DATA_TRANSMISSION=\n" and a second block may follow.
//
// What the numbers are, where the specification leaves room:
//   Positions   centres of bins: theta = (i + 0.5) / n 90 deg, phi = (k + 0.5) / m 180 deg. The format's own renderer
//               looks them up in a texture with these centres and takes whole bins when it samples.
//   phi         between the azimuths of the two directions: 0 side by side, 180 deg in mirror position (the peaks of
//               real files lie in the last bin).
//   Value       f [1/sr], cosine not included: the renderer multiplies by it, and away from the peak real files are
//               reciprocal as they stand (20 and 29 % mean difference; 45 and 37 % if taken to hold cos theta_out).
//   Padding     where the instrument did not reach, real files repeat the last measured angle bit for bit
//               (theta_in above 68 deg, theta_out above 82 deg). Such rows are dropped, except where the row is one
//               constant. By reciprocity, a direction pair whose light is out of reach is looked up swapped.
//   Negatives   are noise and colours out of the gamut: a negative channel reads as 0 and is counted as clipped; a
//               sample negative in every channel is dropped.
//
// evaluate() is trilinear between the centres, constant beyond the outermost; a corner without data leaves the others
// with its weight; where the nearest centre has none, there is no value. Samples are the stored bins.
//
// Takes the content of a file; `name` is for messages. At most 720 theta and 1440 phi steps. Throws files::InputError.
std::unique_ptr<Material> parse_mbsdf(std::string_view bytes, const std::string& name);

inline constexpr std::string_view kMbsdfMagic = "NVIDIA ARC MBSDF V1\n";

}  // namespace likeness::measured
