#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace likeness::brdf {

// A camera's or an observer's three channels as weights at wave numbers 1 / wavelength that are equally far apart: the
// trapezoidal rule over interference, whose fringes are equally far apart there too. For smooth sensitivities its error
// is below all powers of the step until the path difference of a fringe nears 1 / step, 342 um.
struct SpectralWeights {
  static constexpr std::size_t kCount = 512;
  static constexpr double kShortest = 360, kLongest = 780;  // [nm]
  static constexpr double kFirst = 1 / kLongest;            // [1/nm]
  static constexpr double kStep = (1 / kShortest - 1 / kLongest) / double(kCount - 1);

  double weight[kCount][3] = {};  // each channel sums to 1: a white balance

  static double wavelength(std::size_t i) { return 1 / (kFirst + kStep * double(i)); }  // [nm]

  // From a sensitivity per nanometre: color(wavelength in nm) is three numbers, the illuminant included.
  template <class F>
  static SpectralWeights of(F&& color) {
    SpectralWeights out;
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < kCount; ++i) {
      const double nm = wavelength(i);
      const std::array<double, 3> at = color(nm);
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] += out.weight[i][c] = at[c] * nm * nm;  // d lambda = lambda^2 d (1/lambda)
    }
    for (auto& at : out.weight)
      for (std::size_t c = 0; c < 3; ++c) at[c] /= sum[c];
    return out;
  }

  // From a table of N rows at equally spaced wavelengths, linear between them and 0 outside.
  static SpectralWeights of(std::span<const std::array<double, 3>> table, double first_nm, double step_nm) {
    return of([&](double nm) {
      const double at = (nm - first_nm) / step_nm;
      if (!(at >= 0 && at <= double(table.size() - 1))) return std::array<double, 3>{};
      const std::size_t i = at < double(table.size() - 1) ? std::size_t(at) : table.size() - 2;
      const double t = at - double(i);
      std::array<double, 3> out;
      for (std::size_t c = 0; c < 3; ++c) out[c] = table[i][c] * (1 - t) + table[i + 1][c] * t;
      return out;
    });
  }
};

// The color matching functions of the CIE 1931 standard observer.
// Source  Wyman, Sloan and Shirley 2013 (JCGT 2(2)), the multi-lobe fit. White of D65 with it: x 0.3126, y 0.3292, where
//         the tables give 0.3127, 0.3290.
inline std::array<double, 3> cie_1931(double nm) {
  const auto lobe = [nm](double height, double center, double below, double above) {
    const double t = (nm - center) * (nm < center ? below : above);
    return height * std::exp(-0.5 * t * t);
  };
  return {lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) + lobe(-0.065, 501.1, 0.0490, 0.0382),
          lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
          lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725)};
}

// CIE standard illuminant D65 at 360 to 780 nm, relative: the standard's table every 10 nm, linear between its rows as
// the standard has it (CIE 015).
inline double cie_d65(double nm) {
  static constexpr double kTable[]{46.6383, 52.0891, 49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865,
                                   117.008, 117.812, 114.861, 115.923, 108.811, 109.354, 107.802, 104.790, 107.689,
                                   104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987,
                                   83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.3490,
                                   61.6040, 69.8856, 75.0870, 63.5927, 46.4182, 66.8054, 63.3828};
  const double at = std::fmin(std::fmax((nm - 360) / 10, 0), 41.999999999);
  const auto i = std::size_t(at);
  const double t = at - double(i);
  return kTable[i] * (1 - t) + kTable[i + 1] * t;
}

// Linear Rec. 709 under D65. A constant spectrum gives (1, 1, 1); a narrow one may be outside the gamut, where a channel
// is negative.
inline SpectralWeights rec709_under_d65() {
  // From CIE XYZ, made of the primaries and the white of ITU-R BT.709.
  static constexpr double kMatrix[3][3]{{3.24096994, -1.53738318, -0.49861076},
                                        {-0.96924364, 1.87596750, 0.04155506},
                                        {0.05563008, -0.20397696, 1.05697151}};
  return SpectralWeights::of([](double nm) {
    const std::array<double, 3> xyz = cie_1931(nm);
    std::array<double, 3> rgb{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) rgb[i] += kMatrix[i][j] * xyz[j] * cie_d65(nm);
    return rgb;
  });
}

}  // namespace likeness::brdf
