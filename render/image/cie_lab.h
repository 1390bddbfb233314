#pragma once

#include <array>
#include <cmath>
#include <cstddef>

// From linear light with Rec. 709 primaries to CIE XYZ and CIELAB, for D65 (the white of the primaries).
namespace likeness::image {

using Matrix3 = std::array<std::array<double, 3>, 3>;

// XYZ = this times (R, G, B); Y of white is 1. The ratios of integers that the primaries and the white point of sRGB
// (IEC 61966-2-1) give.
inline constexpr Matrix3 kXyzOfRec709{{{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                       {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                       {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}}};

// XYZ of white, (0.9505, 1, 1.0891).
inline constexpr std::array<double, 3> kWhiteOfRec709{kXyzOfRec709[0][0] + kXyzOfRec709[0][1] + kXyzOfRec709[0][2],
                                                      kXyzOfRec709[1][0] + kXyzOfRec709[1][1] + kXyzOfRec709[1][2],
                                                      kXyzOfRec709[2][0] + kXyzOfRec709[2][1] + kXyzOfRec709[2][2]};

// f of CIE 1976: the cube root, and a line below (6 / 29)^3, so that black and negative light have a value.
template <class T>
T lab_curve(T t) {
  constexpr T kDelta = T(6) / 29;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + T(4) / 29;
}

struct Lab {
  double l = 0, a = 0, b = 0;  // L* 0 (black) to 100 (white), a* green to red, b* blue to yellow
};

// `white` is the XYZ that is shown as (100, 0, 0).
inline Lab lab_of_xyz(const std::array<double, 3>& xyz, const std::array<double, 3>& white) {
  const double x = lab_curve(xyz[0] / white[0]), y = lab_curve(xyz[1] / white[1]), z = lab_curve(xyz[2] / white[2]);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

inline std::array<double, 3> xyz_of_rec709(const std::array<double, 3>& rgb) {
  std::array<double, 3> xyz{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) xyz[i] += kXyzOfRec709[i][j] * rgb[j];
  return xyz;
}

inline Lab lab_of_rec709(const std::array<double, 3>& rgb) { return lab_of_xyz(xyz_of_rec709(rgb), kWhiteOfRec709); }

}  // namespace likeness::image
