#include "fit/levenberg_marquardt.h"

#include <cmath>
#include <Eigen/Cholesky>

namespace likeness::fit {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The step that minimises the damped quadratic within the box. `held` variables do not move.
VectorXd step_within(const Quadratic& q, const VectorXd& x, const VectorXd& low, const VectorXd& high,
                     const VectorXd& damping, const std::vector<bool>& held) {
  const Index n = x.size();
  VectorXd step = VectorXd::Zero(n);
  std::vector<bool> active = held;
  // Each pass stops at least one more variable at its bound; a few passes settle nearly all of them, and the
  // caller checks the loss in any case.
  for (int pass = 0; pass < 4; ++pass) {
    MatrixXd m = q.hessian;
    VectorXd right = -q.gradient;
    m.diagonal() += damping;
    for (Index i = 0; i < n; ++i)
      if (active[i]) right -= m.col(i) * step[i];
    for (Index i = 0; i < n; ++i) {
      if (!active[i]) continue;
      m.row(i).setZero();
      m.col(i).setZero();
      m(i, i) = 1;
      right[i] = step[i];
    }
    step = m.llt().solve(right);
    bool stopped = false;
    for (Index i = 0; i < n; ++i) {
      if (active[i]) continue;
      const double to = x[i] + step[i];
      if (to >= low[i] && to <= high[i]) continue;
      step[i] = (to < low[i] ? low[i] : high[i]) - x[i];
      active[i] = true;
      stopped = true;
    }
    if (!stopped) break;
  }
  return step;
}

}  // namespace

Minimiser::Outcome Minimiser::from(VectorXd x) const {
  const Index n = x.size();
  Outcome out;
  x = x.cwiseMax(low).cwiseMin(high);
  Quadratic here = evaluate(x);
  out.evaluations = 1;
  out.steps.push_back({0, here.loss});
  VectorXd scale = VectorXd::Zero(n);
  double damping = 1e-3;
  int small_gains = 0;
  for (int iteration = 1; iteration <= iterations && small_gains < 3; ++iteration) {
    if (stop && stop()) break;
    scale = here.hessian.diagonal().cwiseMax(0.5 * scale).cwiseMax(1e-12);
    std::vector<bool> held(static_cast<std::size_t>(n));
    for (Index i = 0; i < n; ++i)
      held[i] =
          high[i] <= low[i] || (x[i] <= low[i] && here.gradient[i] > 0) || (x[i] >= high[i] && here.gradient[i] < 0);
    bool gained = false;
    while (damping < 1e8) {
      const VectorXd step = step_within(here, x, low, high, damping * scale, held);
      const VectorXd next = (x + step).cwiseMax(low).cwiseMin(high);
      Quadratic there = evaluate(next);
      ++out.evaluations;
      if (std::isfinite(there.loss) && there.loss < here.loss) {
        const double promised = -(2 * here.gradient.dot(step) + step.dot(here.hessian * step));
        const double kept = (here.loss - there.loss) / std::max(promised, 1e-300);
        small_gains = here.loss - there.loss < tolerance * here.loss ? small_gains + 1 : 0;
        x = next;
        here = std::move(there);
        if (kept > 0.75) damping = std::max(damping / 5, 1e-12);
        if (kept < 0.25) damping *= 2;
        gained = true;
        break;
      }
      damping = std::max(damping * 4, 1e-9);
    }
    if (!gained) break;
    out.steps.push_back({iteration, here.loss});
  }
  out.x = std::move(x);
  out.at_x = std::move(here);
  return out;
}

}  // namespace likeness::fit
