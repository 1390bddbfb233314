#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "brdf/diffuse/evaluators.h"
#include "brdf/proxima.h"
#include "tests/brdf/diffuse/draws.h"

// The forms of microfacet_diffuse side by side, as pi f cos_i / rho in double.
namespace likeness::brdf {

enum class Form { kIntegral, kLambert, kProxima, kLut, kAzimuthLut, kFit };
inline constexpr std::array kForms{Form::kLambert, Form::kProxima, Form::kLut, Form::kAzimuthLut, Form::kFit};

constexpr std::string_view name_of(Form form) {
  constexpr std::array<std::string_view, 6> kNames{
      "microfacet_diffuse",    "lambert", "proxima", "microfacet_diffuse_lut", "microfacet_diffuse_azimuth_lut",
      "microfacet_diffuse_fit"};
  return kNames[std::size_t(form)];
}

inline double over_lambert_cos(Form form, double alpha, const PolarPair<double>& p) {
  using std::numbers::pi;
  switch (form) {
    case Form::kIntegral:
      return pi * microfacet_diffuse(alpha, p).f_cos;
    case Form::kLambert:
      return p.cos_i;
    case Form::kProxima: {
      const Vec3<double> l(p.sin_i, 0, p.cos_i), v(p.sin_o * p.cos_phi, p.sin_o * p.sin_phi, p.cos_o);
      return proxima_factor_cos(alpha, p.cos_i, proxima_turn(Geometry<double>(l, v)));
    }
    case Form::kLut:
      return pi * MicrofacetDiffuseLut::tables().eval(alpha, p).f_cos;
    case Form::kAzimuthLut:
      return pi * MicrofacetDiffuseAzimuthLut::tables().eval(alpha, p).f_cos;
    case Form::kFit: {
      const MicrofacetDiffuseFit<double> fit{.base_color = Rgb<double>(1), .alpha = alpha};
      const Vec3<double> l(p.sin_i, 0, p.cos_i), v(p.sin_o * p.cos_phi, p.sin_o * p.sin_phi, p.cos_o);
      return pi * fit.eval_cos(Geometry<double>(l, v)).r;
    }
  }
  return 0;
}

// The part of the light from all around that reaches a viewer, for rho = 1: the integral of f cos_i over the light's
// hemisphere. Midpoint rule in the square root of cos_i and in phi: 2e-3 at alpha = 0.1 and 80 degrees, 2e-4 elsewhere.
inline double albedo(Form form, double alpha, double theta_o) {
  if (form == Form::kIntegral) return microfacet_diffuse_albedo(alpha, std::cos(theta_o), std::sin(theta_o));
  constexpr int kRings = 40, kSectors = 40;
  double sum = 0;
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      const double root = (ring + 0.5) / kRings, phi = std::numbers::pi * (sector + 0.5) / kSectors;
      const PolarPair<double> p = PolarPair<double>::at(theta_o, std::acos(root * root), phi);
      sum += over_lambert_cos(form, alpha, p) * 2 * root;
    }
  return 2 * sum / (kRings * kSectors);
}

}  // namespace likeness::brdf
