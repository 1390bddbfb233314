#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "fit/measured/measured.h"

namespace likeness::measured {

// RGL .bsdf, isotropic and RGB: a tensor file with the adaptive parametrisation of Dupuy and Jakob 2018, "An Adaptive
// Parameterization for Efficient Material Acquisition and Rendering". With theta_i the light's angle, m the half
// vector, phi_m its azimuth from the light's,
//
//     u     = (sqrt(theta_m 2 / pi), (phi_m + pi) / (2 pi))           unit coordinates of m
//     s     = (cumulative of vndf over u.x at u.y, cumulative over u.y)   the inverse of sampling vndf(u; theta_i)
//     f     = rgb(s; theta_i) ndf(u) / (4 sigma(theta_i) cos theta_o)     [1/sr]
//
// Every map is bilinear between nodes that lie on its borders; maps of two neighbouring theta_i are mixed linearly,
// each vndf normalised first. If the file's `jacobian` is 0, ndf / (4 sigma) is already in rgb.
//
// evaluate() inverts this. Samples are the nodes of the stored grid theta_i x s, turned into directions by sampling
// vndf; a node's weight is the solid angle of the directions nearest to it. Nodes at theta_i = 90 deg are
// not visited, so that the weights add up to about 0.9 (2 pi)^2. A field `valid` is not read: its meaning is not published.
//
// Refused, with what is supported: anisotropic files (more than two phi_i), spectral files (`spectra` in place of `rgb`).
// At most 64 theta_i and maps of 512 x 512. Takes the content; `name` is for messages. Throws files::InputError.
std::unique_ptr<Material> parse_rgl(std::string_view bytes, const std::string& name);

inline constexpr std::string_view kTensorMagic{"tensor_file\0", 12};

}  // namespace likeness::measured
