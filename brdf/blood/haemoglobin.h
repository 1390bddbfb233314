#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "brdf/fresnel/spectral_weights.h"

namespace likeness::brdf {

// Molar extinction of haemoglobin, 400 to 720 nm every 10 nm: with oxygen, without [1/cm per mol/l].
// Source  S. Prahl, "Tabulated Molar Extinction Coefficient for Hemoglobin in Water", Oregon Medical Laser Center, 1998
//         (https://omlc.org/spectra/hemoglobin/summary.html), from data of Gratzer and Kollias.
inline constexpr std::size_t kHaemoglobinRows = 33;
inline constexpr double kHaemoglobinFirstNm = 400, kHaemoglobinStepNm = 10;
inline constexpr std::array<std::array<double, 2>, kHaemoglobinRows> kHaemoglobin{
    {{266232, 223296},   {466840, 303956},   {480360, 407560}, {246072, 528600}, {102580, 413280}, {62816, 103292},
     {44480, 23388.8},   {33209.2, 16156.4}, {26629.2, 14550}, {23684.4, 16684}, {20932.8, 20862}, {20035.2, 25773.6},
     {24202.4, 31589.6}, {39956.8, 39036.4}, {53236, 46592},   {43016, 53412},   {32613.2, 53788}, {44496, 45072},
     {50104, 37020},     {14400.8, 28324.4}, {3200, 14677.2},  {1506, 9443.6},   {942, 6509.6},    {610, 5148.8},
     {442, 4345.2},      {368, 3750.12},     {319.6, 3226.56}, {294, 2795.12},   {277.6, 2407.92}, {276, 2051.96},
     {290, 1794.28},     {314, 1540.48},     {348, 1325.88}}};

// Absorption of whole blood of 150 g of haemoglobin a litre [1/mm], by the mean of the two weighted by the oxygen saturation.
inline constexpr double kAbsorptionPerExtinction = 2.302585092994046 * 150 / 64500 / 10;

// The rows as one of three channels sees them, linear Rec. 709 under D65: each channel sums to 1. What lies beyond 400 and
// 720 nm, 0.2 % of the light an eye counts, is added to the rows at the ends.
struct HaemoglobinWeights {
  double weight[kHaemoglobinRows][3] = {};

  HaemoglobinWeights() {
    const SpectralWeights fine = rec709_under_d65();
    for (std::size_t i = 0; i < SpectralWeights::kCount; ++i) {
      const double at = (SpectralWeights::wavelength(i) - kHaemoglobinFirstNm) / kHaemoglobinStepNm;
      const double inside = std::fmin(std::fmax(at, 0.0), double(kHaemoglobinRows - 1) - 1e-9);
      const auto row = std::size_t(inside);
      for (std::size_t c = 0; c < 3; ++c) {
        weight[row][c] += (1 - (inside - double(row))) * fine.weight[i][c];
        weight[row + 1][c] += (inside - double(row)) * fine.weight[i][c];
      }
    }
  }
};

}  // namespace likeness::brdf
