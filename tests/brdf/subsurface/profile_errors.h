#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "brdf/subsurface/burley_profile.h"
#include "brdf/subsurface/gaussian_profile.h"

// How far one profile is from another, and the error that the Gaussians are fitted to.
namespace likeness::brdf {

// A node and its weight of an integral.
struct Node {
  double x, weight;
};
// Gauss-Legendre with 8 points from low to high, added to `nodes`.
inline void append_nodes(double low, double high, std::vector<Node>& nodes) {
  constexpr double kPoint[]{0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  constexpr double kWeight[]{0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  for (int k = 0; k < 4; ++k)
    for (const double side : {-1.0, 1.0})
      nodes.push_back({(low + high) / 2 + side * kPoint[k] * (high - low) / 2, kWeight[k] * (high - low) / 2});
}
// Of an integral over x = s r from 0 to 90, on 60 intervals that grow from 1e-4. Exact to 1e-12 for everything here; beyond
// 90 lies 1e-13 of Burley's light.
inline const std::vector<Node>& radial_nodes() {
  static const std::vector<Node> nodes = [] {
    std::vector<Node> made;
    append_nodes(0, 1e-4, made);
    for (int i = 1; i < 60; ++i)
      append_nodes(1e-4 * std::pow(9e5, (i - 1) / 59.0), 1e-4 * std::pow(9e5, i / 59.0), made);
    return made;
  }();
  return nodes;
}

struct ProfileError {
  double cdf_rms;      // sqrt(integral (P - P0)^2 dr / integral (1 - P0)^2 dr)
  double cdf_worst;    // max |P - P0|: light in the wrong place, of all light
  double density_rms;  // sqrt(integral (p - p0)^2 dr / integral p0^2 dr), p = 2 pi r R / A, without a delta
  double value_rms;    // root mean square of R / R0 - 1 for ln r even in s r = 0.1 to 15
  double value_worst;  // max |R / R0 - 1| there
};

// Of a profile of shape 1, given by R / A and its CDF, against Burley's.
template <class R, class P>
ProfileError error_against_burley(R&& density_over_area, P&& cdf) {
  double cdf_sum = 0, rest = 0, density_sum = 0, density = 0;
  ProfileError error{};
  for (const Node& node : radial_nodes()) {
    const double d = cdf(node.x) - burley_cdf(node.x), rings = 2 * std::numbers::pi * node.x;
    const double p0 = burley_density_over_radius(node.x, 1.0), p = rings * density_over_area(node.x) - p0;
    cdf_sum += node.weight * d * d;
    rest += node.weight * burley_beyond(node.x) * burley_beyond(node.x);
    density_sum += node.weight * p * p;
    density += node.weight * p0 * p0;
    error.cdf_worst = std::max(error.cdf_worst, std::abs(d));
  }
  error.cdf_rms = std::sqrt(cdf_sum / rest);
  error.density_rms = std::sqrt(density_sum / density);
  constexpr int kRadii = 500;
  for (int i = 0; i < kRadii; ++i) {
    const double x = 0.1 * std::pow(150, (i + 0.5) / kRadii);
    const double ratio = density_over_area(x) / burley_density_over_area(x) - 1;
    error.value_rms += ratio * ratio / kRadii;
    error.value_worst = std::max(error.value_worst, std::abs(ratio));
  }
  error.value_rms = std::sqrt(error.value_rms);
  return error;
}
template <int kCount>
ProfileError error_of_gaussians() {
  return error_against_burley([](double x) { return gaussian_density_over_area<kCount>(x * x); },
                              [](double x) { return gaussian_cdf<kCount>(x * x); });
}

// ---- the fit. Weights are a softmax of logits, so that they are positive and have the sum 1; the first logit is 0, and a
// single Gaussian's second one is that of the delta. Then the logarithms of the variances.

template <int kCount>
inline constexpr int kFitParameters = kCount == 1 ? 2 : 2 * kCount - 1;

template <class T, int kCount>
struct FitValues {
  T weight[kCount], variance[kCount], delta;
};
template <int kCount, class T>
FitValues<T, kCount> fit_values(const T* parameters) {
  using std::exp;
  constexpr int kLogits = kCount == 1 ? 1 : kCount - 1;
  T sum(1.0);
  for (int i = 0; i < kLogits; ++i) sum += exp(parameters[i]);
  FitValues<T, kCount> values;
  values.weight[0] = T(1.0) / sum;
  for (int i = 1; i < kCount; ++i) values.weight[i] = exp(parameters[i - 1]) / sum;
  values.delta = kCount == 1 ? T(exp(parameters[0]) / sum) : T(0.0);
  for (int i = 0; i < kCount; ++i) values.variance[i] = exp(parameters[kLogits + i]);
  return values;
}
template <int kCount>
void fit_parameters(double* parameters) {
  constexpr const auto& kFit = kGaussianFit<kCount>;
  constexpr int kLogits = kCount == 1 ? 1 : kCount - 1;
  for (int i = 1; i < kCount; ++i) parameters[i - 1] = std::log(kFit.weight[i] / kFit.weight[0]);
  if (kCount == 1) parameters[0] = std::log(kFit.delta / kFit.weight[0]);
  for (int i = 0; i < kCount; ++i) parameters[kLogits + i] = std::log(kFit.variance[i]);
}

// sqrt(weight) (P - P0) at each node: half their squares' sum is what the fit makes least.
template <int kCount>
struct CdfResiduals {
  template <class T>
  bool operator()(const T* parameters, T* residuals) const {
    using std::exp;
    const auto values = fit_values<kCount>(parameters);
    const auto& nodes = radial_nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      T cdf = values.delta;
      for (int k = 0; k < kCount; ++k)
        cdf += values.weight[k] * (T(1.0) - exp(T(-0.5 * nodes[i].x * nodes[i].x) / values.variance[k]));
      residuals[i] = T(std::sqrt(nodes[i].weight)) * (cdf - T(burley_cdf(nodes[i].x)));
    }
    return true;
  }
};

}  // namespace likeness::brdf
