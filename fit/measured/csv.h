#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "fit/measured/measured.h"

namespace likeness::measured {

// CSV, one row a sample, for a user's own gonioreflectometer:
//
//     theta_i,theta_o,phi,r,g,b[,weight]
//
// A header names the columns, in any order. Angles are radians, or degrees in columns theta_i_deg, theta_o_deg,
// phi_deg. theta_i and theta_o lie in 0..90 deg; phi is between the azimuths of light and viewer (0 side by side, 180 deg
// in mirror position) and is folded to 0..180 deg. r, g, b are f [1/sr], linear, cosine not included. Rows may come in
// any order, leave gaps and repeat (repeats are averaged). '#' begins a comment; empty lines are passed over. At
// most 2 million rows and 128 MB. "nan" and "inf" are dropped and counted, as is a row negative in r, g and b; one
// negative channel reads as 0 and is counted as clipped.
//
// weight [sr^2] is the row's share of d(omega_i) d(omega_o); without the column it is sin theta_i sin theta_o (sines of
// at least sin 0.5 deg), scaled so that all rows add up to (2 pi)^2. A row of weight 0 is looked up but not visited.
//
// evaluate() weighs the 6 nearest samples within kCsvReach by (1 / distance - 1 / distance of the 7th)^2 (Franke and
// Little's form of Shepard 1968): a sample's own directions give its value. The distance of two direction pairs is
// the root of the summed squared chords of light and viewer, at the azimuth that makes it least. Where there is none
// in reach, the swapped pair is tried (reciprocity); else there is no value.
//
// Takes the content; `name` is for messages, which name the line. Throws files::InputError.
std::unique_ptr<Material> parse_csv(std::string_view text, const std::string& name);

inline constexpr double kCsvReach = 0.1;  // 5.7 deg, if one of the two directions is off and the other right

// The valid samples of a material as CSV in radians, with weights, 9 digits.
std::string csv_text(const Material& material);

// Writes them, whole or not at all. Throws std::runtime_error naming the file.
void write_csv(const std::filesystem::path& file, const Material& material);

}  // namespace likeness::measured
