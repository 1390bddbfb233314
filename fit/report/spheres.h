#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "brdf/any_brdf.h"
#include "fit/measured/measured.h"
#include "render/image/picture.h"

// Spheres side by side under one distant light, seen by an orthographic camera: what a material looks like.
namespace likeness::fit {

// Angles between the directions to the camera and to the light [deg], the light to the right: those of the talk.
inline constexpr std::array<double, 3> kSphereLightsDeg{0, 90, 130};
inline constexpr int kSphereSize = 160;  // width and height of one sphere's square [pixels]

struct SpherePicture {
  // Radiance of each pixel under an irradiance of pi at normal incidence, so that a white Lambert surface facing the
  // light has 1; linear RGB, the background included.
  image::Picture radiance;
  std::vector<std::uint8_t> valid;  // 0 where the measured material has no data for the pixel's directions
};

// Where the file has no data and light or camera graze the surface, the value is that of the directions lifted to 88,
// 86, ... 78 deg from the normal, the first that has data.
SpherePicture spheres_of(const measured::Material& material);
SpherePicture spheres_of(const brdf::AnyBrdf& model);

// Displayed in sRGB after exposure by `ev`; what has no data is hatched, the background is the same at every exposure.
image::DisplayPicture spheres_picture(const SpherePicture& spheres, double ev);

// The exposure [EV, whole stops within -4..4] that brings the median luminance of the first sphere nearest to 0.18; no
// higher, so that a black material stays dark.
double spheres_exposure(const SpherePicture& spheres);

}  // namespace likeness::fit
