#pragma once

#include "brdf/evaluator.h"
#include "brdf/subsurface/isotropic_half_space.h"
#include "brdf/subsurface/random_walk.h"

// The random walk, as rows of `likeness eval`. Computed in double whatever the precision of a row.
namespace likeness::brdf {

// clang-format off
struct RandomWalkProfile : Plain<RandomWalkProfile> {
  static constexpr std::string_view kName = "random_walk_profile";
  static constexpr std::string_view kText = "profile of a scattering half space by Monte Carlo: the reference";
  static constexpr bool kOneByOne = true;
  static constexpr std::array kInputs{
      Parameter{.name = "r", .initial = 1, .range = {0, 1e9}, .typical = {0.01, 10}, .unit = "length", .role = Role::kCoordinate,
                .logarithmic = true, .text = "distance along the surface"},
      Parameter{.name = "alpha", .initial = 0.9, .range = {0, 1}, .typical = {0.3, 0.99}, .role = Role::kScale,
                .text = "single-scattering albedo; random_walk_albedo gives the surface's"},
      Parameter{.name = "g", .initial = 0, .range = {-0.99, 0.99}, .typical = {-0.3, 0.9}, .text = "mean cosine of scattering (Henyey-Greenstein)"},
      Parameter{.name = "eta", .initial = 1, .range = {1, 4}, .typical = {1, 1.5}, .text = "index of refraction of the medium; 1 neither reflects nor refracts"},
      Parameter{.name = "mean_free_path", .initial = 1, .range = {1e-6, 1e6}, .typical = {0.1, 10}, .unit = "length", .logarithmic = true, .text = "1 / sigma_t"},
      Parameter{.name = "diffuse", .initial = 0, .range = {0, 1}, .typical = {0, 1}, .role = Role::kMix, .text = "0: light enters along the normal; 1: from all sides"},
      Parameter{.name = "analog", .initial = 0, .range = {0, 1}, .typical = {0, 0}, .role = Role::kMix, .text = "0: weighted walks; 1: the plain simulation"},
      Parameter{.name = "width", .initial = 0.05, .range = {1e-3, 0.5}, .typical = {0.02, 0.1}, .text = "half the width of the ring around r, over r"},
      Parameter{.name = "walks", .initial = 10000, .range = {2, 1e7}, .typical = {1e3, 1e5}, .logarithmic = true, .text = "how many"},
      Parameter{.name = "seed", .initial = 1, .range = {0, 16777216}, .typical = {0, 1000}, .role = Role::kCoordinate, .text = "a whole number"}};
  static constexpr std::array kOutputs{
      Output{.name = "R", .unit = "1/length^2", .text = "mean over the ring, of 1 unit of flux that enters at a point"},
      Output{.name = "R_error", .unit = "1/length^2", .text = "its standard error"},
      Output{.name = "albedo", .text = "part of the light that comes back"},
      Output{.name = "albedo_error", .text = "its standard error"}};
  template <Scalar S>
  static void evaluate(const S* in, S* out) {
    const auto number = [&](int i) { return static_cast<double>(Arithmetic<S>::value(in[i])); };
    const double length = number(4);
    const WalkEstimate walked = random_walk_at(
        {.alpha = number(1), .g = number(2), .eta = number(3)}, number(5) > 0.5 ? Incidence::kDiffuse : Incidence::kPencil,
        number(0) / length, number(7), std::llround(number(8)), std::uint64_t(std::llround(number(9))),
        number(6) > 0.5 ? Estimator::kAnalog : Estimator::kWeighted);
    const double per_area = 1 / (walked.area * length * length);
    out[0] = constant<S>(walked.ring.mean() * per_area);
    out[1] = constant<S>(walked.ring.error() * per_area);
    out[2] = constant<S>(walked.total.mean());
    out[3] = constant<S>(walked.total.error());
  }
};

struct RandomWalkAlbedo : Plain<RandomWalkAlbedo> {
  static constexpr std::string_view kName = "random_walk_albedo";
  static constexpr std::string_view kText = "surface albedo of a half space that scatters isotropically, exactly";
  static constexpr bool kOneByOne = true;
  static constexpr std::array kInputs{
      Parameter{.name = "alpha", .initial = 0.9, .range = {0, 1}, .typical = {0.3, 0.99}, .role = Role::kScale, .text = "single-scattering albedo"}};
  static constexpr std::array kOutputs{
      Output{.name = "pencil", .text = "surface albedo, light along the normal"},
      Output{.name = "diffuse", .text = "surface albedo, light from all sides"}};
  template <Scalar S>
  static void evaluate(const S* in, S* out) {
    const auto alpha = static_cast<double>(Arithmetic<S>::value(in[0]));
    out[0] = constant<S>(plane_albedo(1, alpha));
    out[1] = constant<S>(spherical_albedo(alpha));
  }
};
// clang-format on

}  // namespace likeness::brdf
