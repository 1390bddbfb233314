#pragma once

#include <algorithm>
#include <array>

#include <Eigen/Dense>

#include "brdf/diffuse/microfacet_diffuse_fit.h"
#include "tests/brdf/diffuse/draws.h"

// How the numbers of brdf/diffuse/microfacet_diffuse_fit.h come about.
namespace likeness::brdf {

struct LeastSquares {
  std::array<double, 5> best;
  double rms_of_best, rms_of_header;  // of both errors together, over the same draws
};

// The coefficients that leave the least sum of two mean squares: of fit / integral - 1, and of twice the albedo less
// that of the integral, or less 1 where the integral's is above. Energy needs no constraint: the form has it.
inline LeastSquares least_squares(int draws) {
  constexpr int kSize = 5;
  constexpr double kAlbedoWeight = 2;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  Eigen::Matrix<double, kSize, kSize> normal = Eigen::Matrix<double, kSize, kSize>::Zero();
  Vector right = Vector::Zero(), row;
  double square = 0;
  const auto add = [&](double rest) {
    normal += row * row.transpose() / draws;
    right += row * rest / draws;
    square += rest * rest / draws;
  };
  for (int n = 0; n < draws; ++n) {
    const Draw at = draw(n, Directions::kByCosine);
    const PolarPair<double> p = at.pair();
    const double s = p.sin_o * p.sin_i * p.cos_phi, q = p.cos_o * p.cos_o + p.cos_i * p.cos_i;
    const double want = std::numbers::pi * microfacet_diffuse(at.alpha, p).f;
    row << s, s * at.alpha, s * q, s * q * at.alpha, 0.5 - q;
    row *= at.alpha / want;
    add(1 - 1 / want);
    row << 0, 0, 0, 0, -kAlbedoWeight * at.alpha * p.cos_o * p.cos_o;
    add(kAlbedoWeight * (std::min(1.0, microfacet_diffuse_albedo(at.alpha, p.cos_o, p.sin_o)) - 1));
  }
  const auto rms = [&](const Vector& k) { return std::sqrt(square - 2 * k.dot(right) + k.dot(normal * k)); };
  const Vector best = normal.ldlt().solve(right);
  LeastSquares out{};
  for (int i = 0; i < kSize; ++i) out.best[std::size_t(i)] = best[i];
  out.rms_of_best = rms(best);
  out.rms_of_header = rms(Vector(MicrofacetDiffuseFit<double>::kCoefficients.data()));
  return out;
}

}  // namespace likeness::brdf
