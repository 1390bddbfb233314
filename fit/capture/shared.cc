#include "fit/capture/shared.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Dense>
#include <tbb/parallel_for.h>

#include "fit/capture/shared_sums.h"
#include "fit/levenberg_marquardt.h"
#include "render/files/files.h"
#include "render/files/interrupt.h"

namespace likeness::capture_fit {
namespace {

using Callisto = brdf::Callisto<double>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kToSigma = 1.4826;
constexpr double kLeastScale = 1e-4;  // of the level: photos are no truer than that
constexpr double kLeastGain = 0.01;   // of the loss, for a group to be taken; and by what a parameter must move it
constexpr double kLeastLoss = 1e-6;   // q = 1e-6: a thousandth of the scale
constexpr double kWideSigma = 0.25;   // of the typical range: beyond it the data do not determine a parameter
constexpr std::size_t kFew = 400;     // faces that choose between starts and groups

Callisto neutral() {
  Callisto m;
  for (std::size_t g = 0; g < kSharedGroups.size(); ++g) member(m, 2 * g) = kSharedGroups[g].neutral;
  m.specular_fresnel_falloff = kMatteFalloff;
  return m;
}

// 1.4826 median |r| of Lambert, over all samples; the weights and the scale in turn.
double scale_of(const std::vector<Face>& faces) {
  double scale = 0.05;
  for (int round = 0; round < 4; ++round) {
    std::vector<std::vector<double>> squares(faces.size());
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t i) {
      FaceShading shading;
      Colored colored;
      shade(neutral(), faces[i], shading);
      color_of(faces[i], shading, scale, colored);
      if (colored.is_known) squares[i] = colored.squares;
    });
    std::vector<double> all;
    for (const auto& part : squares) all.insert(all.end(), part.begin(), part.end());
    if (all.empty()) return kLeastScale;
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    scale = std::max(kToSigma * std::sqrt(*middle), kLeastScale);
  }
  return scale;
}

// A search over what is free.
struct Search {
  const std::vector<Face>& faces;
  double scale;
  const std::function<bool(double)>& step;

  struct Found {
    Callisto material = neutral();
    double loss = 0;
    Groups groups = kNoGroup;
    std::vector<std::size_t> variables;
    std::vector<fit::Step> steps;
  };
  // `held`: variables that are not moved although their group is free.
  Found from(Callisto start, Groups groups, const std::vector<std::size_t>& held, int iterations) const {
    Found out;
    out.material = start;
    out.groups = groups;
    for (std::size_t i = 0; i < kSharedParameters; ++i)
      if ((groups >> (i / 2) & 1u) != 0 && std::ranges::find(held, i) == held.end()) out.variables.push_back(i);
    if (out.variables.empty()) {
      out.loss = sums_of(faces, start, scale, groups, {}).loss;
      return out;
    }
    const auto n = static_cast<Index>(out.variables.size());
    fit::Minimiser search;
    search.low = search.high = VectorXd(n);
    search.iterations = iterations;
    search.stop = [this] {
      if (!step(0)) throw files::Interrupted();
      return false;
    };
    VectorXd x(n);
    for (Index i = 0; i < n; ++i) {
      const auto variable = out.variables[static_cast<std::size_t>(i)];
      search.low[i] = row_of(variable).range.low;
      search.high[i] = row_of(variable).range.high;
      x[i] = member(start, variable);
    }
    const auto at = [&](const VectorXd& point) {
      Callisto m = start;
      for (Index i = 0; i < n; ++i) member(m, out.variables[static_cast<std::size_t>(i)]) = point[i];
      return m;
    };
    search.evaluate = [&](const VectorXd& point) {
      Sums sums = sums_of(faces, at(point), scale, groups, out.variables);
      return fit::Quadratic{sums.loss, std::move(sums.gradient), std::move(sums.hessian)};
    };
    const auto outcome = search.from(x);
    out.material = at(outcome.x);
    out.loss = outcome.at_x.loss;
    out.steps = outcome.steps;
    return out;
  }
};

constexpr std::array kRoughnessStarts{0.25, 0.5, 0.8};
constexpr int kShort = 6, kLong = 40;  // iterations: to compare starts, and to the end

bool is_gain(double loss, double of) { return of - loss > kLeastGain * of && of - loss > kLeastLoss; }

// Group by group, each from where the one before ended, and kept if the loss says that the photos know of it.
Search::Found grown(const Search& search, double lambert_loss) {
  Search::Found best;
  best.loss = lambert_loss;
  std::optional<Search::Found> glossy;
  for (const double roughness : kRoughnessStarts) {
    Callisto start = neutral();
    start.specular = 0.5;
    start.specular_fresnel_falloff = kGlossyFalloff;
    start.roughness = roughness;
    Search::Found found = search.from(start, 1, {}, kShort);
    if (!glossy || found.loss < glossy->loss) glossy = std::move(found);
  }
  if (is_gain(glossy->loss, best.loss)) best = std::move(*glossy);
  for (std::size_t g = 1; g < kSharedGroups.size(); ++g) {
    Callisto start = best.material;
    // Off the neutral value, where the shape would have no slope.
    member(start, 2 * g) = kSharedGroups[g].neutral + 0.2;
    Search::Found found = search.from(start, best.groups | 1u << g, {}, kShort);
    if (is_gain(found.loss, best.loss)) best = std::move(found);
  }
  return best;
}

std::vector<double> sigmas_of(const std::vector<Face>& faces, const Search::Found& found, double scale) {
  const Sums sums = sums_of(faces, found.material, scale, found.groups, found.variables);
  Callisto m = found.material;
  std::vector<Index> inside;
  for (std::size_t i = 0; i < found.variables.size(); ++i) {
    const brdf::Parameter& row = row_of(found.variables[i]);
    const double value = member(m, found.variables[i]);
    if (value > row.range.low && value < row.range.high && sums.hessian(Index(i), Index(i)) > 0)
      inside.push_back(Index(i));
  }
  std::vector<double> out(found.variables.size(), kNaN);
  if (inside.empty()) return out;
  const auto n = static_cast<Index>(inside.size());
  MatrixXd h(n, n), scatter(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const double unit = std::sqrt(sums.hessian(inside[i], inside[i]) * sums.hessian(inside[j], inside[j]));
      h(i, j) = sums.hessian(inside[i], inside[j]) / unit;
      scatter(i, j) = sums.scatter(inside[i], inside[j]) / unit;
    }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(h);
  if (!(eigen.eigenvalues()[0] > 1e-10)) return out;
  const MatrixXd inverse = h.inverse(), covariance = inverse * scatter * inverse;
  for (Index i = 0; i < n; ++i)
    out[static_cast<std::size_t>(inside[i])] = std::sqrt(covariance(i, i) / sums.hessian(inside[i], inside[i]));
  return out;
}

// By how much of itself the loss rises where a variable moves through its typical range.
double influence(const std::vector<Face>& faces, const Search::Found& found, std::size_t variable, double scale) {
  const auto& typical = row_of(variable).typical;
  const double here = sums_of(faces, found.material, scale, found.groups, {}).loss;
  double most = 0;
  for (const double t : {0.0, 0.5, 1.0}) {
    Callisto moved = found.material;
    member(moved, variable) = typical.low + t * (typical.high - typical.low);
    const double loss = sums_of(faces, moved, scale, found.groups, {}).loss;
    most = std::max(most, (loss - here) / std::max(here, kLeastLoss));
  }
  return most;
}

}  // namespace

SharedFit fit_shared(const std::vector<Face>& faces, const std::function<bool(double)>& step) {
  SharedFit out;
  out.scale = scale_of(faces);
  const Search search{faces, out.scale, step};
  const Sums lambert = sums_of(faces, neutral(), out.scale, kNoGroup, {});
  out.lambert_loss = lambert.loss;
  out.lambert_rms = std::sqrt(lambert.squares / std::max(lambert.weights, 1e-300));
  std::vector<Face> few;
  const std::size_t stride = std::max<std::size_t>(1, faces.size() / kFew);
  for (std::size_t i = 0; i < faces.size(); i += stride) few.push_back(faces[i]);
  Search::Found found = grown(Search{few, out.scale, step}, sums_of(few, neutral(), out.scale, kNoGroup, {}).loss);
  std::array<std::string, kSharedParameters> why;
  std::vector<std::size_t> held;
  std::vector<double> sigma;
  // What the data leave open goes back to its default, and the others are searched again without it.
  for (int round = 0; round < 3; ++round) {
    found = search.from(found.material, found.groups, held, kLong);
    sigma = sigmas_of(faces, found, out.scale);
    bool is_changed = false;
    for (std::size_t i = 0; i < found.variables.size() && lambert.samples > 0; ++i) {
      const std::size_t v = found.variables[i];
      const brdf::Parameter& row = row_of(v);
      const bool is_wide = sigma[i] > kWideSigma * (row.typical.high - row.typical.low);
      const bool is_free = influence(few, found, v, out.scale) < kLeastGain;
      if (!is_wide && !is_free) continue;
      why[v] = is_wide ? "its standard deviation of " + files::number_text(std::round(sigma[i] * 1e3) / 1e3) +
                             " is beyond a quarter of its usual range"
                       : "no value in its usual range changes the loss by 1 %";
      // The strength takes its shape along.
      member(found.material, v) = v % 2 == 0 ? kSharedGroups[v / 2].neutral : row.initial;
      if (v % 2 == 0) {
        found.groups &= ~(1u << v / 2);
        if (v == 0) found.material.specular_fresnel_falloff = kMatteFalloff;
        member(found.material, v + 1) = row_of(v + 1).initial;
      } else {
        held.push_back(v);
      }
      is_changed = true;
      break;
    }
    if (!is_changed) break;
    if (round == 2) {
      found = search.from(found.material, found.groups, held, kLong);
      sigma = sigmas_of(faces, found, out.scale);
    }
  }
  out.material = found.material;
  out.convergence = found.steps;
  const Sums end = sums_of(faces, found.material, out.scale, found.groups, {});
  out.callisto_loss = end.loss;
  out.callisto_rms = std::sqrt(end.squares / std::max(end.weights, 1e-300));

  for (const brdf::Parameter& row : Callisto::kParameters) {
    fit::Estimate e;
    e.name = row.name;
    e.sigma = kNaN;
    std::size_t v = 0;
    while (v < kSharedParameters && name_of(v) != row.name) ++v;
    if (v == kSharedParameters) {
      if (row.channels != 1) continue;  // base_color is a map; tints stay white
      e.value = row.name == std::string_view("specular_fresnel_falloff") ? out.material.specular_fresnel_falloff
                                                                         : row.initial;
      e.matters = false;
      e.why = "not searched";
      out.estimates.push_back(std::move(e));
      continue;
    }
    e.value = member(out.material, v);
    const auto at = std::ranges::find(found.variables, v);
    e.fitted = at != found.variables.end();
    if (e.fitted) {
      e.sigma = sigma[static_cast<std::size_t>(at - found.variables.begin())];
      e.at_bound = e.value <= row.range.low || e.value >= row.range.high;
    } else {
      e.matters = false;
      e.why = !why[v].empty() ? why[v]
              : v % 2 == 0    ? "it does not lower the loss by 1 %"
                              : std::string(kSharedGroups[v / 2].strength) + " is neutral";
    }
    out.estimates.push_back(std::move(e));
  }
  return out;
}

}  // namespace likeness::capture_fit
