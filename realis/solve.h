#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include <glm/vec3.hpp>

#include "realis/basis.h"

namespace likeness::realis {

// Coefficients of one texel after the other from its residuals: the c that minimises
//
//     sum_i w_i (e_i - sum_k c_k G_k(l_i))^2 + sum_k (c_k / spread_k)^2
//
// Whatever the lights are, the second sum keeps c finite and small where nothing is known: c_k^2 <= spread_k^2
// sum_i w_i e_i^2. Not for several threads at once: it keeps its workspace.
class Solver {
 public:
  explicit Solver(Basis basis);
  ~Solver();
  Solver(Solver&&) noexcept;

  const Basis& basis() const;

  // The lights from now on (unit, from the texel to the light): of the capture, if they are distant, or of the texel.
  void aim(std::span<const glm::dvec3> to_lights);

  // `weights` of each light, >= 0 (0: not seen); `residuals` of each light [1/sr], `channels` of them one after the other
  // (light by light within a channel); `coefficients` of each lobe, likewise. A residual whose weight is 0 is not read.
  void solve(std::span<const double> weights, std::span<const double> residuals, std::span<double> coefficients);

  // The same of these lobes only (positions in the basis, none twice); the coefficients of the others are 0.
  void solve_with(std::span<const std::size_t> lobes, std::span<const double> weights,
                  std::span<const double> residuals, std::span<double> coefficients);

  // solve(), and, of more than `kept` lobes, the same once more with those that have the largest parts: |c| in all channels.
  void solve_kept(std::size_t kept, std::span<const double> weights, std::span<const double> residuals,
                  std::span<double> coefficients);

  // What is left of each residual when the coefficients are those of all other lights: e_i - sum_k c_k^(-i) G_k(l_i), in
  // closed form (Allen's PRESS for ridge regression). Of a light of weight 0: not held out, since it was never in.
  void held_out(std::span<const double> weights, std::span<const double> residuals, std::span<double> left);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace likeness::realis
