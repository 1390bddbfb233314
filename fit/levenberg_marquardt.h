#pragma once

#include <functional>
#include <vector>
#include <Eigen/Core>

#include "fit/result/result.h"

namespace likeness::fit {

// A least-squares loss |r|^2 near a point, as its normal equations.
struct Quadratic {
  double loss = 0;
  Eigen::VectorXd gradient;  // J^T r, half the gradient of the loss
  Eigen::MatrixXd hessian;   // J^T J
};

// Minimises |r(x)|^2 within a box by Levenberg and Marquardt's method on the normal equations.
//
// Source      More 1978 (scaling by the largest diagonal met so far); the box by an active set: a variable at
//             a bound whose gradient points outwards is held, one that a step would carry across its bound
//             is stopped there and the rest of the step solved again.
// Holds       the loss never rises, and x is within the bounds, at every step.
// Why not     ceres::Solve: it takes unbounded steps and projects them afterwards, which on these problems
//             (half of the variables end at a bound) needs 2.4 times the evaluations: docs/decisions/0001-bounded-levenberg-marquardt.md.
struct Minimiser {
  std::function<Quadratic(const Eigen::VectorXd& x)> evaluate;
  Eigen::VectorXd low, high;
  int iterations = 60;
  double tolerance = 1e-6;          // stop when three steps in a row gain less than this part of the loss
  std::function<bool()> stop = {};  // asked before every step; true ends the search where it is

  struct Outcome {
    Eigen::VectorXd x;
    Quadratic at_x;
    std::vector<Step> steps;
    int evaluations = 0;
  };
  Outcome from(Eigen::VectorXd x) const;
};

}  // namespace likeness::fit
