#include "fit/levenberg_marquardt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <Eigen/Cholesky>

#include "tests/fit/ceres_slice.h"

namespace likeness::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void expect_a_proper_search(const Minimiser& m, const Minimiser::Outcome& out) {
  for (std::size_t i = 1; i < out.steps.size(); ++i) EXPECT_LE(out.steps[i].loss, out.steps[i - 1].loss);
  for (Index i = 0; i < out.x.size(); ++i) {
    EXPECT_GE(out.x[i], m.low[i]);
    EXPECT_LE(out.x[i], m.high[i]);
  }
  EXPECT_EQ(out.at_x.loss, m.evaluate(out.x).loss) << "the quadratic is not the one of x";
}

// (x - center)^T H (x - center), whose least within the box is known: H (x* - center) is 0 inside and points
// outwards at a bound.
struct Bowl {
  MatrixXd hessian;
  VectorXd center;
  Quadratic operator()(const VectorXd& x) const {
    const VectorXd d = x - center;
    return {d.dot(hessian * d), hessian * d, hessian};
  }
};

TEST(LevenbergMarquardt, FindsKnownActiveSetsOfBoundedQuadratics) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const Index n = 1 + trial % 12;
    MatrixXd j(2 * n, n);
    for (Index r = 0; r < 2 * n; ++r)
      for (Index c = 0; c < n; ++c) j(r, c) = u(random) - 0.3;  // correlated: condition numbers of tens to hundreds
    const MatrixXd hessian = j.transpose() * j;
    VectorXd low = VectorXd::Constant(n, -1), high = VectorXd::Constant(n, 1), best(n), slope = VectorXd::Zero(n);
    for (Index i = 0; i < n; ++i) {
      const double kind = u(random);
      best[i] = kind < 0.3 ? -1 : kind < 0.6 ? 1 : 1.8 * u(random) - 0.9;
      if (kind < 0.3) slope[i] = 0.1 + u(random);
      else if (kind < 0.6) slope[i] = -0.1 - u(random);
    }
    const Bowl bowl{hessian, best - hessian.llt().solve(slope)};
    const Minimiser m{.evaluate = bowl, .low = low, .high = high, .iterations = 200, .tolerance = 1e-14};
    VectorXd start(n);
    for (Index i = 0; i < n; ++i) start[i] = 2 * u(random) - 1;
    const auto out = m.from(start);
    expect_a_proper_search(m, out);
    EXPECT_LT((out.x - best).cwiseAbs().maxCoeff(), 1e-5) << "trial " << trial << ", " << n << " variables";  // damping
  }
}

TEST(LevenbergMarquardt, FollowsRosenbrocksValleyIntoTheBound) {
  const auto rosenbrock = [](const VectorXd& x) {
    const double a = 10 * (x[1] - x[0] * x[0]), b = 1 - x[0];
    Eigen::Matrix2d j;
    j << -20 * x[0], 10, -1, 0;
    const Eigen::Vector2d r(a, b);
    return Quadratic{r.squaredNorm(), j.transpose() * r, j.transpose() * j};
  };
  for (const double bound : {0.5, 2.0})
    for (const double y : {-2.0, 0.0, 2.0}) {
      const Minimiser m{.evaluate = rosenbrock,
                        .low = Eigen::Vector2d(-2, -2),
                        .high = Eigen::Vector2d(bound, 2),
                        .iterations = 500,
                        .tolerance = 1e-14};
      const auto out = m.from(Eigen::Vector2d(-1.5, y));
      expect_a_proper_search(m, out);
      const double x = std::min(bound, 1.0);
      EXPECT_NEAR(out.x[0], x, 1e-6) << bound << ", " << y;  // the tolerance's root, 1e-7
      EXPECT_NEAR(out.x[1], x * x, 1e-6) << bound << ", " << y;
    }
}

TEST(LevenbergMarquardt, StartsOutsideAreBroughtInAndFixedVariablesStay) {
  const Bowl bowl{MatrixXd::Identity(2, 2), Eigen::Vector2d(0.5, 0.5)};
  const Minimiser m{.evaluate = bowl, .low = Eigen::Vector2d(0, 0.2), .high = Eigen::Vector2d(1, 0.2)};
  const auto out = m.from(Eigen::Vector2d(7, -7));
  expect_a_proper_search(m, out);
  EXPECT_NEAR(out.x[0], 0.5, 1e-6);  // the default tolerance: 1e-6 of the loss
  EXPECT_EQ(out.x[1], 0.2);
}

// What a model gives where its formula breaks down is worse than anything.
TEST(LevenbergMarquardt, StepsBackFromNaN) {
  const Bowl bowl{MatrixXd::Identity(1, 1), VectorXd::Constant(1, 1.0)};
  const Minimiser m{.evaluate =
                        [&](const VectorXd& x) {
                          Quadratic q = bowl(x);
                          if (x[0] > 0.9) q.loss = kNaN, q.gradient.setConstant(kNaN), q.hessian.setConstant(kNaN);
                          return q;
                        },
                    .low = VectorXd::Constant(1, -5.0),
                    .high = VectorXd::Constant(1, 5.0)};
  const auto out = m.from(VectorXd::Constant(1, -4.0));
  expect_a_proper_search(m, out);
  EXPECT_GT(out.x[0], 0.5);
  EXPECT_LE(out.x[0], 0.9);
  // A start at NaN ends at once, and says so.
  const auto lost = m.from(VectorXd::Constant(1, 2.0));
  EXPECT_TRUE(std::isnan(lost.at_x.loss));
  EXPECT_LT(lost.evaluations, 100);
}

TEST(LevenbergMarquardt, StopsWhenToldTo) {
  const Bowl bowl{MatrixXd::Identity(1, 1), VectorXd::Constant(1, 1.0)};
  int asked = 0;
  Minimiser m{.evaluate = bowl, .low = VectorXd::Constant(1, -5.0), .high = VectorXd::Constant(1, 5.0)};
  m.stop = [&] { return ++asked == 3; };
  EXPECT_EQ(m.from(VectorXd::Constant(1, -4.0)).steps.size(), 3u) << "the start and two steps";
  m.stop = [] { return true; };
  EXPECT_EQ(m.from(VectorXd::Constant(1, -4.0)).x[0], -4.0);
}

// The same residuals, bounds, starts and tolerance through ceres::Solve; its numbers are in docs/decisions/0001. From
// one start either may end in the better valley; what a multi-start buys with its evaluations is what counts.
TEST(LevenbergMarquardt, GoesAsLowAsCeresForTheSameEvaluations) {
  constexpr int kStarts = 20;
  double theirs = 1e300, ours = 1e300;
  int their_evaluations = 0, our_evaluations = 0, same_starts = 0, not_above = 0, starts = 0;
  for (int start = 0; start < kStarts; ++start) {
    const test::Search a = test::searched_by_likeness(start), b = test::searched_by_ceres(start);
    not_above += a.loss <= b.loss * 1.001;  // both stop at gains of 1e-6: a thousandth is the same valley
    same_starts += a.evaluations;
    their_evaluations += b.evaluations;
    theirs = std::min(theirs, b.loss);
  }
  for (; our_evaluations < their_evaluations; ++starts) {
    const test::Search a = test::searched_by_likeness(starts);
    ours = std::min(ours, a.loss);
    our_evaluations += a.evaluations;
  }
  std::printf(
      "from 20 starts: not above Ceres in %d; evaluations %d, Ceres %d; for %d evaluations %d starts, best %.4g, "
      "Ceres %.4g\n",
      not_above, same_starts, their_evaluations, our_evaluations, starts, ours, theirs);
  EXPECT_LE(ours, theirs * 1.02);                   // 1.009 measured: as good, and no claim to be better
  EXPECT_LT(same_starts, 0.6 * their_evaluations);  // 0.42 measured
  EXPECT_GE(not_above, 9);                          // 12 of 20 measured; a search that stalls early loses more
}

}  // namespace
}  // namespace likeness::fit
