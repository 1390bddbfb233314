#include "tests/fit/ceres_slice.h"

#include <ceres/ceres.h>

#include <random>
#include <stdexcept>
#include <vector>

#include "brdf/jet.h"
#include "fit/coordinates.h"
#include "fit/levenberg_marquardt.h"
#include "fit/objective.h"
#include "tests/fit/known_materials.h"

namespace likeness::fit::test {
namespace {

constexpr int kVariables = 23;  // of the full tier

// Neither a model that the fit can meet exactly nor noise: a Disney 2012 gloss, which Callisto only approaches.
brdf::AnyBrdf target() {
  brdf::Disney2012<double> m;
  m.base_color = {0.5, 0.25, 0.1};
  m.roughness = 0.35;
  m.clearcoat = 0.6;
  m.sheen = 0.5;
  return m;
}

struct Problem {
  std::vector<SlicePoint> points;
  SampleSet samples;
  Coordinates coordinates;
};

Problem problem() {
  const Evaluated material(target());
  std::vector<SlicePoint> some;
  const auto all = slice_points(material, 80);
  for (std::size_t i = 0; i < all.size(); i += 11) some.push_back(all[i]);
  SampleSet samples = samples_of(material, some);
  return {std::move(some), std::move(samples), coordinates_of(brdf::Callisto<double>{}, brdf::Tier::kFull)};
}

const Problem& fixed() {
  static const Problem made = problem();
  return made;
}

struct Begin {
  Eigen::VectorXd x, low, high;
};

Begin begin_of(int start) {
  const auto n = static_cast<Eigen::Index>(fixed().coordinates.size());
  if (n != kVariables) throw std::logic_error("the full tier has other variables than this test");
  std::mt19937 random(static_cast<unsigned>(start));
  Begin b{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const Coordinate& v = fixed().coordinates.variables[static_cast<std::size_t>(i)];
    b.low[i] = v.low;
    b.high[i] = v.high;
    b.x[i] = v.start_low + (v.start_high - v.start_low) * static_cast<double>(random()) / 4294967296.0;
  }
  return b;
}

// The residuals of Loss::kLog, written from their definition.
struct Residuals {
  const Problem& problem;
  template <class T>
  bool operator()(const T* x, T* out) const {
    std::vector<T> channels(problem.coordinates.fixed.begin(), problem.coordinates.fixed.end());
    for (std::size_t i = 0; i < problem.coordinates.size(); ++i)
      for (const int c : problem.coordinates.variables[i].channels) channels[static_cast<std::size_t>(c)] = x[i];
    const auto model = brdf::model_from_channels<brdf::Callisto, T>(channels.data());
    const double mean = 1 / std::sqrt(3.0 * static_cast<double>(problem.points.size()));
    for (const SlicePoint& p : problem.points) {
      const auto g = model.eval(p.at_stored);
      const T value[3] = {g.r, g.g, g.b};
      const double f[3] = {p.f.r, p.f.g, p.f.b};
      for (int c = 0; c < 3; ++c) {
        *out++ = mean * (std::log1p(f[c] * p.at_stored.cos_i) - log(T(1) + value[c] * p.at_stored.cos_i));
        *out++ = mean * kShownWeight * (std::min(f[c], 1.0) - (value[c] < T(1) ? value[c] : T(1)));
      }
    }
    return true;
  }
};

}  // namespace

Search searched_by_likeness(int start) {
  const Begin begin = begin_of(start);
  const Problem& p = fixed();
  const Minimiser minimiser{
      .evaluate = [&](const Eigen::VectorXd& x) { return objective(p.samples, p.coordinates, x, Fineness::kExact); },
      .low = begin.low,
      .high = begin.high,
      .iterations = 200,
      .tolerance = 1e-6};
  const auto out = minimiser.from(begin.x);
  return {out.at_x.loss, out.evaluations};
}

Search searched_by_ceres(int start) {
  const Begin begin = begin_of(start);
  std::vector<double> x(begin.x.data(), begin.x.data() + begin.x.size());
  ceres::Problem least_squares;
  least_squares.AddResidualBlock(new ceres::AutoDiffCostFunction<Residuals, ceres::DYNAMIC, kVariables>(
                                     new Residuals{fixed()}, 6 * static_cast<int>(fixed().points.size())),
                                 nullptr, x.data());
  for (int i = 0; i < kVariables; ++i) {
    least_squares.SetParameterLowerBound(x.data(), i, begin.low[i]);
    least_squares.SetParameterUpperBound(x.data(), i, begin.high[i]);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-6;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &least_squares, &summary);
  return {2 * summary.final_cost, summary.num_residual_evaluations + summary.num_jacobian_evaluations};
}

}  // namespace likeness::fit::test
