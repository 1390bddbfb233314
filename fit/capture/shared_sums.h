#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "fit/capture/shared.h"

// The loss of the shared parameters and its derivatives, with the colors projected out.
namespace likeness::capture_fit {

// Variables are numbered: the strength of group g is 2 g, its shape 2 g + 1.
inline std::string_view name_of(std::size_t variable) {
  return variable % 2 == 0 ? kSharedGroups[variable / 2].strength : kSharedGroups[variable / 2].shape;
}
inline const brdf::Parameter& row_of(std::size_t variable) {
  return *std::ranges::find(brdf::Callisto<double>::kParameters, name_of(variable), &brdf::Parameter::name);
}
// The scalar member of a material that a variable is.
template <class S>
S& member(brdf::Callisto<S>& m, std::size_t variable) {
  S* const all[kSharedParameters]{&m.specular,          &m.roughness,
                                  &m.smooth_terminator, &m.smooth_terminator_length,
                                  &m.diffuse_fresnel,   &m.diffuse_fresnel_falloff,
                                  &m.retroreflection,   &m.retroreflection_falloff};
  return *all[variable];
}

// Groups that are free, as bits; the others are neutral.
using Groups = unsigned;
inline constexpr Groups kNoGroup = 0;

struct Sums {
  double loss = 0;                  // mean over samples of ln(1 + q)
  double squares = 0, weights = 0;  // of weight times q scale^2, and of weights
  double samples = 0;
  Eigen::VectorXd gradient;          // half the gradient of the loss
  Eigen::MatrixXd hessian, scatter;  // J^T W J; and the sum over faces of their gradients squared
  void clear(Eigen::Index n) {
    *this = {};
    gradient = Eigen::VectorXd::Zero(n);
    hessian = scatter = Eigen::MatrixXd::Zero(n, n);
  }
};

// The sums over all faces, divided by the number of samples (but scatter, by its square). Without variables: the loss alone.
// Faces are summed in an order that does not depend on the number of threads.
Sums sums_of(const std::vector<Face>& faces, const brdf::Callisto<double>& material, double scale, Groups groups,
             const std::vector<std::size_t>& variables);

}  // namespace likeness::capture_fit
