#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/capture/capture.h"

// Lists of lights that others write. All have x to the right, y up and z towards the camera, which is the world of a
// capture that is imported with one of them. Every reader throws files::InputError, one line with the place.
namespace likeness::olat_import {

struct ListedLight {
  std::string file;      // the photograph, as the list names it; empty: the list names none
  capture::Light light;  // without an id
};
struct LightList {
  std::vector<ListedLight> lights;
  std::string remarks;  // comments of the file, for people and for what they say of the color space
};

inline constexpr std::size_t kMostListBytes = std::size_t{1} << 26;

// lights.csv: remarks after #, the header file,lx,ly,lz,ir,ig,ib, then a row a photograph: direction to the light, and the
// intensity that linear pixels are divided by. The last three columns may be left out.
LightList read_lights_csv(std::string_view text, const std::string& source);

// .lp of reflectance transformation imaging: a line with the count, then "file x y z". Lengths are dropped: what programs
// write there is a direction. A name may hold blanks.
LightList read_lp(std::string_view text, const std::string& source);

// .dome of RelightLab, JSON: lightConfiguration says which of directions, positionsSphere, positions3d (or positions)
// holds; an entry is {"x", "y", "z"} or [x, y, z]. lightsCalibration gives intensity and whiteBalance, ledAdjust a color.
// `meters` is the length of the file's unit, which the file does not state; 0: not known, and refused for positions.
LightList read_dome(std::string_view text, const std::string& source, double meters);

// The text of an .lp of these lights and files.
std::string lp_text(const std::vector<ListedLight>& lights);

}  // namespace likeness::olat_import
