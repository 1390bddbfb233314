#pragma once

#include <cmath>

#include "fit/measured/measured.h"

namespace likeness::measured {

// Rusinkiewicz's coordinates of a pair of directions, radians: theta_h and theta_d in 0..pi/2, phi_d in 0..pi (two
// directions swapped, or mirrored, have the same coordinates). brdf::geometry_at is the inverse.
struct HalfAngles {
  double theta_h, theta_d, phi_d;
};

// Source  Rusinkiewicz 1998, "A New Change of Variables". Angles are taken by atan2, so that those near 0, where
//         a mirror peak lies, keep their digits. Where phi_d has no meaning (theta_h or theta_d is 0) it is 0.
inline HalfAngles half_angles(const Direction& l, const Direction& v) {
  const double hx = l.x + v.x, hy = l.y + v.y, hz = l.z + v.z;
  const double dx = l.x - v.x, dy = l.y - v.y, dz = l.z - v.z;
  const double across = std::sqrt(hx * hx + hy * hy), length = std::sqrt(across * across + hz * hz);
  // x', y' are the tangents at h: y' is horizontal, x' points down the meridian.
  const double cos_phi = across > 0 ? hx / across : 1, sin_phi = across > 0 ? hy / across : 0;
  const double cos_h = length > 0 ? hz / length : 1, sin_h = length > 0 ? across / length : 0;
  // d is half of l - v in the frame of h: l + v has no part across h.
  const double x = cos_h * (dx * cos_phi + dy * sin_phi) - sin_h * dz;
  const double y = dy * cos_phi - dx * sin_phi;
  double phi_d = std::atan2(y, x);
  if (phi_d < 0) phi_d += 3.14159265358979323846;
  return {std::atan2(across, hz), std::atan2(std::sqrt(dx * dx + dy * dy + dz * dz), length), phi_d};
}

// The other coordinates of an isotropic pair: the two elevations in 0..pi/2, and the difference of the azimuths, in
// 0..pi (0 side by side, pi in mirror position; 0 where one direction is the normal).
struct Elevations {
  double theta_i, theta_o, phi;
};

inline Elevations elevations(const Direction& l, const Direction& v) {
  const auto elevation = [](const Direction& d) { return std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z); };
  return {elevation(l), elevation(v), std::abs(std::atan2(l.x * v.y - l.y * v.x, l.x * v.x + l.y * v.y))};
}

// A pair with the light in the x-z plane. The viewer is on the side of -y, where phi_d of the pair is that of the MERL bin
// whose elevations these are: the mirrored pair belongs to another bin, though a mirror-symmetric f is the same there.
inline void directions_at(const Elevations& e, Direction& l, Direction& v) {
  l = {std::sin(e.theta_i), 0, std::cos(e.theta_i)};
  v = {std::sin(e.theta_o) * std::cos(e.phi), -std::sin(e.theta_o) * std::sin(e.phi), std::cos(e.theta_o)};
}

}  // namespace likeness::measured
