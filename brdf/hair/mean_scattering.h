#pragma once

#include <numbers>

#include "brdf/grid.h"
#include "brdf/hair/azimuthal.h"

// What a fibre does on the average over its width and over light from all azimuths of one side: how much goes on to the
// other side and how much comes back, lobe by lobe. Dual scattering knows a fibre by this alone.
namespace likeness::brdf {

// Energies of one lobe over all inclinations, [1]: the longitudinal term's integral is 1, so they are integrals of the
// far-field azimuthal term N_p over phi. Light comes evenly from half a circle of azimuths and leaves over the other half
// (forward) or the same (backward): of what turns by phi, |phi| / pi goes on. Zinke 2008, mean attenuation; it is the
// average over phi_i in the Enemies slides.
template <Scalar S>
struct LobeScattering {
  S forward, backward;           // phi beyond and within a quarter turn of the light; their sum is the lobe's energy
  S first_cosine, third_cosine;  // integral of N_p cos(phi) and of N_p cos(3 phi)
};
inline constexpr std::size_t kMeanValues = 4 * kHairLobes;

// Characteristic function of the trimmed logistic at a whole frequency: integral of D(x) cos(k x), by Simpson's rule
// over what is not below 1e-17 of the peak.
inline double trimmed_logistic_cosine(int k, double s) {
  constexpr int kSteps = 2000;
  const double end = std::min(std::numbers::pi, 40 * s);
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = end * i / kSteps;
    sum += (i == 0 || i == kSteps ? 1 : i % 2 ? 4 : 2) * trimmed_logistic(x, s) * std::cos(k * x);
  }
  return 2 * sum * end / (3 * kSteps);
}

// The share of a lobe, a trimmed logistic centred at `centre` (any angle), that comes back: the mean of 1 - |phi| / pi.
// By parts: of the logistic's integral C(x), whose own integral K has a closed form.
inline double backward_share(double centre, double s) {
  constexpr double kPi = std::numbers::pi;
  const double c = std::abs(centre - 2 * kPi * std::floor(centre / (2 * kPi) + 0.5));  // in [0, pi]
  const auto k = [&](double x) {
    const double y = std::abs(x) / (2 * s);  // ln(2 cosh y) = y + log1p(exp(-2 y))
    return 0.5 * x + s * (y + std::log1p(std::exp(-2 * y))) / std::tanh(kPi / (2 * s));
  };
  const double rising = (k(-c) - k(-kPi)) + (k(kPi) - k(kPi - c)), falling = k(kPi - c) - k(-c);
  return (c - rising + falling) / kPi;
}

// A width of the logistic with its Fourier coefficients, which cost more than anything else here.
struct LogisticWidth {
  double s, first_cosine, third_cosine;
  explicit LogisticWidth(double s_)
      : s(s_), first_cosine(trimmed_logistic_cosine(1, s_)), third_cosine(trimmed_logistic_cosine(3, s_)) {}
};

// Everything of one fibre by quadrature over its width: 0.5 integral over h, midpoints of the angle gamma, h = sin gamma.
// Four values for each lobe, in the order of LobeScattering.
//
//     cos_theta  cosine of the inclination of the light, [0, 1];  eta  index >= 1
//     width      of the logistic, s > 0 [rad];  sigma_a  absorption per radius >= 0
inline void mean_scattering(double cos_theta, double eta, const LogisticWidth& width, double sigma_a, int steps,
                            double* out) {
  for (std::size_t k = 0; k < kMeanValues; ++k) out[k] = 0;
  for (int i = 0; i < steps; ++i) {  // even in h: only one half
    const double gamma = (i + 0.5) / steps * (std::numbers::pi / 2);
    const double h = std::sin(gamma), cos_h = std::cos(gamma), weight = cos_h * (std::numbers::pi / 2) / steps;
    const FibrePath<double> path(gamma, h, cos_h, cos_theta, eta);
    const auto a = hair_attenuations(path.reflected, path.transmitted, 2 * sigma_a * path.chord);
    for (int p = 0; p < kHairLobes; ++p) {
      double* lobe = out + 4 * p;
      const double energy = weight * a[std::size_t(p)];
      if (p == 3) {  // leaves evenly
        lobe[0] += 0.5 * energy;
        lobe[1] += 0.5 * energy;
        continue;
      }
      const double centre = 2 * (p * path.gamma_t - path.gamma_i) + p * std::numbers::pi;
      const double back = backward_share(centre, width.s);
      lobe[0] += energy * (1 - back);
      lobe[1] += energy * back;
      lobe[2] += energy * std::cos(centre) * width.first_cosine;
      lobe[3] += energy * std::cos(3 * centre) * width.third_cosine;
    }
  }
}

// The same from a table for one index: axes cos_theta, s and sigma_a. Baked in a fraction of a second; 590 kB.
//
//     x = sqrt(cos_theta)            Fresnel rises steeply towards grazing
//     y = s / (s + 0.5)
//     z = sigma_a / (sigma_a + 0.5)  0 white, 1 black
//
// Range  eta as baked; s in [0.02, 5]; any cos_theta in [0, 1] and sigma_a >= 0. docs/models/dual_scattering.md has the
// error along each axis.
struct MeanScatteringTable {
  static constexpr double kLeastWidth = 0.02, kMostWidth = 5;
  using Values = Grid<24, 16, 24, kMeanValues>;
  Values grid;

  explicit MeanScatteringTable(double eta = 1.55) {
    const auto of_ratio = [](double t) { return t < 1 ? 0.5 * t / (1 - t) : 1e9; };
    for (std::size_t y = 0; y < Values::kPoints[1]; ++y) {
      const LogisticWidth width(of_ratio(kLow + Values::coordinate(1, y) * (kHigh - kLow)));
      for (std::size_t z = 0; z < Values::kPoints[2]; ++z)
        for (std::size_t x = 0; x < Values::kPoints[0]; ++x) {
          const double root = Values::coordinate(0, x);
          double out[kMeanValues];
          mean_scattering(root * root, eta, width, of_ratio(Values::coordinate(2, z)), kSteps, out);
          for (std::size_t k = 0; k < kMeanValues; ++k)
            grid.data[Values::index(x, y, z) + k] = static_cast<float>(out[k]);
        }
    }
  }

  // Of the four lobes.
  template <Scalar S>
  std::array<LobeScattering<S>, kHairLobes> lookup(const S& cos_theta, const S& s, const S& sigma_a) const {
    S out[kMeanValues];
    const S width = larger(s, S(0)), absorption = larger(sigma_a, S(0)), half = S(0.5);
    const S y = (width / (width + half) - constant<S>(kLow)) * constant<S>(1 / (kHigh - kLow));
    grid.lookup(safe_sqrt(clamp01(cos_theta)), y, S(S(1) - half / (absorption + half)), out);
    std::array<LobeScattering<S>, kHairLobes> lobes;
    for (std::size_t p = 0; p < kHairLobes; ++p)
      lobes[p] = {out[4 * p], out[4 * p + 1], out[4 * p + 2], out[4 * p + 3]};
    return lobes;
  }

 private:
  static constexpr int kSteps = 96;
  static constexpr double kLow = kLeastWidth / (kLeastWidth + 0.5), kHigh = kMostWidth / (kMostWidth + 0.5);
};

// Mean over the lobes of one half: energy, shift and variance of the inclination. Lobe p of a fibre turns the inclination
// of light by shifts[p] on the average, with variance variances[p]. Where nothing is scattered, shift and variance are 0.
template <Scalar S>
struct MeanScatter {
  S energy, shift, variance;  // [1], [rad], [rad^2]
};

template <Scalar S>
MeanScatter<S> mean_of_lobes(const std::array<S, kHairLobes>& energies, const std::array<S, kHairLobes>& shifts,
                             const std::array<S, kHairLobes>& variances) {
  S energy(0.0), shift(0.0), square(0.0);
  for (std::size_t p = 0; p < kHairLobes; ++p) {
    energy = energy + energies[p];
    shift = shift + energies[p] * shifts[p];
  }
  const S scale = S(1) / larger(energy, constant<S>(kTiny<S>));
  shift = shift * scale;
  for (std::size_t p = 0; p < kHairLobes; ++p)
    square = square + energies[p] * (variances[p] + squared(S(shifts[p] - shift)));
  return {energy, shift, S(square * scale)};
}

}  // namespace likeness::brdf
