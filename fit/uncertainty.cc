#include "fit/uncertainty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <Eigen/Eigenvalues>

namespace likeness::fit {

namespace {

using brdf::Callisto;
using brdf::squared;
using Eigen::Index;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kMattersFrom = 0.01;  // of the loss

// Standard deviation of each variable; NaN for those at a bound, or that the data leave free.
std::vector<double> deviations(const SampleSet& samples, const Coordinates& coordinates, const Eigen::VectorXd& x) {
  const Quadratic q = objective(samples, coordinates, x, Fineness::kExact);
  std::vector<Index> inside;
  for (Index i = 0; i < x.size(); ++i) {
    const Coordinate& v = coordinates.variables[i];
    if (x[i] > v.low && x[i] < v.high && q.hessian(i, i) > 0) inside.push_back(i);
  }
  std::vector<double> out(coordinates.size(), kNaN);
  const auto n = static_cast<Index>(inside.size());
  if (n == 0) return out;
  // Scaled to a unit diagonal, so that what counts as singular does not depend on units.
  const Quadratic spread = objective(samples, coordinates, x, Fineness::kExact, true);
  Eigen::MatrixXd m(n, n), scatter(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const double scale = std::sqrt(q.hessian(inside[i], inside[i]) * q.hessian(inside[j], inside[j]));
      m(i, j) = q.hessian(inside[i], inside[j]) / scale;
      scatter(i, j) = spread.hessian(inside[i], inside[j]) / scale;
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(m);
  Eigen::VectorXd reciprocal(n);
  std::vector<bool> undetermined(static_cast<std::size_t>(n));
  for (Index k = 0; k < n; ++k) {
    // A direction that the data leave free (relative to rounding in J^T J) makes what it moves undetermined.
    const bool free = eigen.eigenvalues()[k] <= 1e-12;
    reciprocal[k] = free ? 0 : 1 / eigen.eigenvalues()[k];
    for (Index i = 0; free && i < n; ++i)
      if (squared(eigen.eigenvectors()(i, k)) > 1e-6) undetermined[static_cast<std::size_t>(i)] = true;
  }
  const Eigen::MatrixXd inverse = eigen.eigenvectors() * reciprocal.asDiagonal() * eigen.eigenvectors().transpose();
  const Eigen::MatrixXd covariance = inverse * scatter * inverse;
  const double count = static_cast<double>(residual_count(samples));
  const double small_sample = count / std::max(count - static_cast<double>(n), 1.0);
  // The sums of objective() are divided by 3 sum(weights); of a covariance that is quadratic in the residuals one such
  // factor is left.
  const double scale = residual_scale(samples);
  for (Index i = 0; i < n; ++i)
    out[static_cast<std::size_t>(inside[i])] =
        undetermined[static_cast<std::size_t>(i)]
            ? kNaN
            : std::sqrt(small_sample * scale * covariance(i, i) / q.hessian(inside[i], inside[i]));
  return out;
}

// The largest rise of the loss, as a share of it, when one variable moves through its range.
double influence(const SampleSet& samples, const Coordinates& coordinates, const Eigen::VectorXd& x, Index i,
                 double loss) {
  const Coordinate& v = coordinates.variables[i];
  double most = 0;
  for (const double t : {0.0, 0.3, 0.7, 1.0}) {
    Eigen::VectorXd moved = x;
    moved[i] = v.start_low + (v.start_high - v.start_low) * t;
    const double there = objective(samples, coordinates, moved, Fineness::kCoarse).loss;
    if (!(there <= loss * (1 + most))) most = there / loss - 1;
  }
  return most;
}

// Why a parameter of Callisto does not matter, in the words of its model.
std::string reason(const brdf::AnyBrdf& any, const std::string& name) {
  const auto* m = std::get_if<Callisto<double>>(&any);
  const std::string fallback = "the data within the cut hardly depend on it";
  if (m == nullptr) return fallback;
  const double base = std::max({m->base_color.r, m->base_color.g, m->base_color.b});
  const bool of_diffuse = name.starts_with("diffuse_fresnel") || name.starts_with("retroreflection");
  if (of_diffuse && base * (1 - m->metallic) < 1e-3) return "there is no diffuse reflection for it to act on";
  if (name.starts_with("diffuse_fresnel_") && m->diffuse_fresnel == 1)
    return "diffuse_fresnel is 1: its mask has no effect";
  if (name.starts_with("retroreflection_") && m->retroreflection == 1)
    return "retroreflection is 1: its mask has no effect";
  if (of_diffuse) return "its mask is hardly reached within the cut";
  if (name.starts_with("smooth_terminator_") && m->smooth_terminator == 0) return "smooth_terminator is 0";
  if (name.starts_with("smooth_terminator") && m->smooth_terminator_length < 1e-3) return "its length is 0";
  if (name == "dual_specular_roughness_scale" && m->dual_specular_opacity < 1e-6) return "dual_specular_opacity is 0";
  if (name == "roughness" && m->dual_specular_opacity > 1 - 1e-6)
    return "dual_specular_opacity is 1: only its product with the scale counts";
  if (name == "metallic" && base < 1e-3) return "base_color is black";
  if (name == "specular" && m->metallic > 1 - 1e-3) return "metallic is 1: base_color is f0";
  return fallback;
}

}  // namespace

std::vector<Estimate> estimates_of(const SampleSet& samples, const Coordinates& coordinates,
                                   const std::vector<double>& folded_channels) {
  const std::vector<double> at = coordinates.at_channels(folded_channels);
  const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(at.data(), static_cast<Index>(at.size()));
  const std::vector<double> sigma = deviations(samples, coordinates, x);
  const double coarse_loss = objective(samples, coordinates, x, Fineness::kCoarse).loss;
  const brdf::AnyBrdf model = unfolded(coordinates.model, folded_channels);
  const std::vector<double> values = plain_channels(model);

  std::vector<Estimate> out;
  const auto add = [&](const brdf::Parameter& row, int color, double value) {
    Estimate e;
    e.name = row.name;
    e.channel = row.channels == 3 ? color : -1;
    e.value = value;
    e.sigma = kNaN;
    e.at_bound = value <= row.range.low || value >= row.range.high;
    out.push_back(std::move(e));
  };
  std::visit(
      [&](const auto& m) {
        std::size_t at_channel = 0;
        for (const brdf::Parameter& row : m.kParameters)
          for (int c = 0; c < row.channels; ++c) add(row, c, values[at_channel++]);
      },
      model);

  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const Coordinate& v = coordinates.variables[i];
    const bool matters = influence(samples, coordinates, x, static_cast<Index>(i), coarse_loss) >= kMattersFrom;
    for (Estimate& e : out) {
      if (e.name != v.name || (v.color >= 0 && e.channel != v.color)) continue;
      e.fitted = true;
      e.matters = matters;
      e.sigma = matters && !e.at_bound ? sigma[i] : kNaN;
      if (!matters) e.why = reason(model, e.name);
    }
  }

  // A product was fitted: the intensity is its largest channel and takes that channel's deviation, the tint's others
  // are divided by the intensity.
  const auto find = [&](std::string_view name, int channel) {
    return std::ranges::find_if(out, [&](const Estimate& e) { return e.name == name && e.channel == channel; });
  };
  std::visit(
      [&](const auto& m) {
        for (const brdf::Parameter& row : m.kParameters) {
          if (row.tints.empty()) continue;
          const auto first = find(row.name, 0);
          if (first == out.end() || !first->fitted) continue;
          const auto scale = find(row.tints, -1);
          scale->fitted = true;
          scale->matters = std::any_of(first, first + 3, [](const Estimate& e) { return e.matters; });
          if (!scale->matters) scale->why = first->why;
          for (auto e = first; e != first + 3; ++e) {
            e->matters = e->matters && scale->value != 0;
            if (!e->matters && e->why.empty()) e->why = scale->name + " is 0";
            // The product's variable may be inside its bounds while the tint, the largest channel, is 1 by convention.
            const double product = e->value * scale->value;
            const auto variable = std::ranges::find_if(coordinates.variables, [&](const Coordinate& v) {
              return v.name == row.name && v.color == e->channel;
            });
            const double s = sigma[static_cast<std::size_t>(variable - coordinates.variables.begin())];
            e->at_bound = product <= variable->low || product >= variable->high;
            if (e->value == 1) {
              scale->sigma = scale->matters ? s : kNaN;
              e->sigma = kNaN;
            } else {
              e->sigma = e->matters ? s / std::abs(scale->value) : kNaN;
            }
          }
        }
      },
      model);
  return out;
}

}  // namespace likeness::fit
