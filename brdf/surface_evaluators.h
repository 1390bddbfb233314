#pragma once

#include "brdf/any_brdf.h"
#include "brdf/evaluator.h"

// The surface models and their parts, as rows of `likeness eval`.
namespace likeness::brdf {

// The GGX distribution of normals alone.
struct GgxD : Plain<GgxD> {
  static constexpr std::string_view kName = "ggx_d";
  static constexpr std::string_view kText = "GGX distribution of normals";
  // clang-format off
  static constexpr std::array kInputs{
      Parameter{.name = "roughness", .initial = 0.5, .range = {0, 1}, .typical = {0.05, 0.9},
                .text = "square root of the slope roughness alpha; alpha is kept above 1e-4"},
      Parameter{.name = "cos_h", .initial = 1, .range = {0, 1}, .typical = {0, 1}, .role = Role::kCoordinate,
                .text = "cosine between the normal and the half vector"},
  };
  static constexpr std::array kOutputs{Output{.name = "d", .unit = "1/sr", .text = "D(h)"}};
  // clang-format on
  static constexpr std::size_t kFeatures = 3;  // roughness, cos, sin^2: near 1 a float's cosine has lost the angle
  struct Form {
    static constexpr const auto& kInputs = GgxD::kInputs;
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      features[0] = in[0];
      features[1] = in[1];
      features[2] = (S(1) - in[1]) * (S(1) + in[1]);
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = ggx_distribution(alpha_of_roughness(f[0]), f[1], f[2]);
  }
};

using SurfaceEvaluators =
    std::tuple<Surface<Lambert>, Surface<BurleyDiffuse>, Surface<Disney2012>, Surface<Ggx>, GgxD, Surface<Callisto>>;

}  // namespace likeness::brdf
