#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "fit/capture/capture_fit.h"
#include "realis/apply.h"
#include "render/capture/capture.h"
#include "render/image/picture.h"

// Pictures of a capture under lights, for programs that take display values.
namespace likeness::realis {

// A bake with all that it is relit from.
struct Relightable {
  capture::Capture capture;
  std::size_t camera = 0;
  StoredBake stored;
  capture_fit::Fit surface;
};

// CAPTURE/realis/NAME. Throws files::UsageError if there is none, with the command that makes it, and files::InputError.
Relightable read_relightable(const capture::Capture& capture, const std::string& name);

// What `likeness realis apply` makes of a light of unit strength; the direction is in the frame of the picture.
image::Picture relit(const Relightable& subject, const glm::dvec3& to_light);

// Lights of which the camera has photographs and whose place is known, in the order of the capture.
struct Photographed {
  std::size_t light = 0, frame = 0;  // in the capture
  glm::dvec3 to_light{0, 0, 1};  // unit, in the frame of the picture; of near lights as seen from the world's origin
};
std::vector<Photographed> photographed(const capture::Capture& capture, std::size_t camera);

// Stops that put the 99th percentile of the pictures' luminance on 1, to a tenth, as the comparison tool does; pixels that are
// not finite or not above 0 do not count. 0 of pictures without light.
double exposure_of(std::span<const image::Picture> pictures);

// Display values [0, 1] of linear light after exposure: the sRGB curve, clipped. What is not finite is 0.
image::Picture displayed(image::Picture picture, double ev);
image::DisplayPicture rounded(const image::Picture& display_values);

}  // namespace likeness::realis
