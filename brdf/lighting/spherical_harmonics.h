#pragma once

#include <array>
#include <cstddef>
#include <numbers>

#include "brdf/vector.h"

namespace likeness::brdf {

// Real spherical harmonics of bands 0 to 2, orthonormal over the sphere, of a unit vector (x, y, z). No sign of Condon
// and Shortley: every one is a positive number times
//
//     i      0    1    2    3    4    5    6          7    8
//     l, m   0,0  1,-1 1,0  1,1  2,-2 2,-1 2,0        2,1  2,2
//            1    y    z    x    xy   yz   3z^2 - 1   xz   x^2 - y^2
//
// Source  Ramamoorthi and Hanrahan 2001 ("An efficient representation for irradiance environment maps"), which has the
//         same functions and signs; index i = l (l + 1) + m.
inline constexpr std::size_t kShCount = 9;

namespace sh {
inline constexpr double kBand0 = 0.28209479177387814;   // sqrt(1 / (4 pi))
inline constexpr double kBand1 = 0.48860251190291992;   // sqrt(3 / (4 pi))
inline constexpr double kCross = 1.0925484305920792;    // sqrt(15 / (4 pi)), of xy, yz, xz
inline constexpr double kZonal = 0.31539156525252001;   // sqrt(5 / (16 pi)), of 3z^2 - 1
inline constexpr double kSector = 0.54627421529603959;  // sqrt(15 / (16 pi)), of x^2 - y^2
}  // namespace sh

// A 3x3 rotation by its rows.
template <Scalar S>
struct Rotation {
  Vec3<S> x{S(1), S(0), S(0)}, y{S(0), S(1), S(0)}, z{S(0), S(0), S(1)};

  Vec3<S> operator*(const Vec3<S>& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }

  // About the direction of `turn`, by its length in radians; no rotation at length 0 (Rodrigues's formula).
  static Rotation about(const Vec3<S>& turn) {
    const S angle2 = dot(turn, turn);
    const auto usable = greater(angle2, constant<S>(1e-8));
    const S angle = S(sqrt(pick(usable, angle2, S(1)))), half = sin(S(S(0.5) * angle)) / angle;
    // sin(a) / a and (1 - cos a) / a^2, with the first terms of their series near 0.
    const S s = pick(usable, S(sin(angle) / angle), S(S(1) - angle2 * constant<S>(1.0 / 6)));
    const S c = pick(usable, S(S(2) * half * half), S(S(0.5) - angle2 * constant<S>(1.0 / 24)));
    const S xx = c * turn.x * turn.x, yy = c * turn.y * turn.y, zz = c * turn.z * turn.z;
    const S xy = c * turn.x * turn.y, yz = c * turn.y * turn.z, xz = c * turn.x * turn.z;
    Rotation out;
    out.x = {S(1) - yy - zz, xy - s * turn.z, xz + s * turn.y};
    out.y = {xy + s * turn.z, S(1) - xx - zz, yz - s * turn.x};
    out.z = {xz - s * turn.y, yz + s * turn.x, S(1) - xx - yy};
    return out;
  }
};

// A function on the sphere by its coefficients, one channel.
template <Scalar S>
struct Sh {
  std::array<S, kShCount> c = zeros();

  // The basis at a unit vector.
  static std::array<S, kShCount> basis(const Vec3<S>& d) {
    const S one = constant<S>(sh::kBand1), two = constant<S>(sh::kCross);
    return {constant<S>(sh::kBand0),
            one * d.y,
            one * d.z,
            one * d.x,
            two * d.x * d.y,
            two * d.y * d.z,
            constant<S>(sh::kZonal) * (S(3) * d.z * d.z - S(1)),
            two * d.x * d.z,
            constant<S>(sh::kSector) * (d.x - d.y) * (d.x + d.y)};
  }

  // Adds a sample: value times the solid angle [sr] it stands for. A projection is the sum over the sphere.
  void add(const Vec3<S>& direction, const S& value_times_solid_angle) {
    const auto y = basis(direction);
    for (std::size_t i = 0; i < kShCount; ++i) c[i] = c[i] + y[i] * value_times_solid_angle;
  }

  S eval(const Vec3<S>& direction) const {
    const auto y = basis(direction);
    S sum = c[0] * y[0];
    for (std::size_t i = 1; i < kShCount; ++i) sum = sum + c[i] * y[i];
    return sum;
  }

  // Convolved with the clamped cosine: the irradiance [W/m2] by normal, if this is radiance [W/(m2 sr)].
  // Source  Ramamoorthi and Hanrahan 2001: A_0 = pi, A_1 = 2 pi / 3, A_2 = pi / 4.
  Sh convolved_with_cosine() const {
    Sh out;
    for (std::size_t i = 0; i < kShCount; ++i)
      out.c[i] = c[i] * constant<S>(std::numbers::pi * (i == 0 ? 1 : i < 4 ? 2.0 / 3 : 0.25));
    return out;
  }

  // The function turned by R: its value at R d is this one's at d. Exact in every band: band 1 is a vector, and band 2
  // the symmetric matrix M of the form d^T M d, which turns into R M R^T.
  Sh rotated(const Rotation<S>& r) const {
    Sh out;
    out.c[0] = c[0];
    const Vec3<S> first = r * Vec3<S>(c[3], c[1], c[2]);
    out.c[1] = first.y;
    out.c[2] = first.z;
    out.c[3] = first.x;

    const S cross = constant<S>(0.5 * sh::kCross), zonal = constant<S>(sh::kZonal) * c[6];
    const S sector = constant<S>(sh::kSector) * c[8];
    const S xy = cross * c[4], yz = cross * c[5], xz = cross * c[7];
    const Vec3<S> m_x(sector - zonal, xy, xz), m_y(xy, S(-sector - zonal), yz), m_z(xz, yz, S(S(2) * zonal));
    const auto form = [&](const Vec3<S>& a, const Vec3<S>& b) {  // a^T M b
      return dot(a, Vec3<S>(dot(m_x, b), dot(m_y, b), dot(m_z, b)));
    };
    const S per_cross = constant<S>(2 / sh::kCross);
    out.c[4] = per_cross * form(r.x, r.y);
    out.c[5] = per_cross * form(r.y, r.z);
    out.c[6] = constant<S>(0.5 / sh::kZonal) * form(r.z, r.z);
    out.c[7] = per_cross * form(r.x, r.z);
    out.c[8] = constant<S>(0.5 / sh::kSector) * (form(r.x, r.x) - form(r.y, r.y));
    return out;
  }

 private:
  static std::array<S, kShCount> zeros() {
    return {S(0.0), S(0.0), S(0.0), S(0.0), S(0.0), S(0.0), S(0.0), S(0.0), S(0.0)};
  }
};

}  // namespace likeness::brdf
