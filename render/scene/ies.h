#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "render/scene/scene.h"

namespace likeness::scene {

inline constexpr std::size_t kMostProfileBytes = std::size_t{16} << 20;

// A photometric file of IES LM-63 (1986, 1991, 1995, 2002), type C or B. Candela are multiplied by the file's multiplier
// and its ballast factors. Angles are those of the file, completed by the symmetry it states with the horizontal ones:
//
//   type C  one plane: a body of revolution, kept as one;  0 to 90: mirrored at the planes 0-180 and 90-270;
//           0 to 180: mirrored at the plane 0-180;  90 to 270: mirrored at the plane 90-270;  0 to 360: as it is
//   type B  0 to 90: mirrored at the plane 0;  -90 to 90: as it is;  so with its vertical angles
//
// so that type C spans [0, 360] and type B [-90, 90], unless the file is a body of revolution. Vertical angles that the
// file does not cover are dark. A tilt table is read over: the lamp is as it was measured. Throws files::InputError,
// one line that begins with `source`.
Profile profile_of(std::string_view text, const std::string& source);

// Largest candela; 0 for a dark profile.
float peak(const Profile& profile);

// The integral over the sphere of the profile over its peak [sr], bilinear between its angles (each cell by the closed
// form of the cosine). 0 for a dark one.
double solid_angle(const Profile& profile);

}  // namespace likeness::scene
