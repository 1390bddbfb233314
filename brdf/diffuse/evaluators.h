#pragma once

#include "brdf/diffuse/microfacet_diffuse.h"
#include "brdf/diffuse/microfacet_diffuse_fit.h"
#include "brdf/diffuse/microfacet_diffuse_lut.h"
#include "brdf/evaluator.h"

// What brdf/diffuse computes, as rows of `likeness eval`.
namespace likeness::brdf {

// clang-format off
inline constexpr Parameter kAlphaRow{.name = "alpha", .initial = 0.25, .range = {0, 1}, .typical = {0.01, 1},
                                     .text = "slope roughness of the normals, roughness^2; 0 is Lambert"};
inline constexpr std::array kMicrofacetOutputs{
    Output{.name = "f_over_base", .unit = "1/sr", .text = "BRDF without the cosine, over the base color"},
    Output{.name = "f_cos_over_base", .unit = "1/sr", .text = "the same times cos_i"},
};

// The ways to name a pair of directions and alpha, for what reads alpha and a PolarPair.
struct AlphaAndAngles {
  static constexpr std::array kInputs{
      kAlphaRow,
      Parameter{.name = "theta_o", .initial = 0, .range = {0, kHalfPi}, .typical = {0, kHalfPi}, .unit = "rad", .role = Role::kAngle,
                .text = "angle between the normal and the viewer"},
      Parameter{.name = "theta_i", .initial = 0, .range = {0, kHalfPi}, .typical = {0, kHalfPi}, .unit = "rad", .role = Role::kAngle,
                .text = "angle between the normal and the light"},
      Parameter{.name = "phi", .initial = 0, .range = {-2 * kHalfPi, 4 * kHalfPi}, .typical = {0, 2 * kHalfPi}, .unit = "rad",
                .role = Role::kAngle, .text = "azimuth between them; 0 is the same side, pi the mirror's"},
  };
  // clang-format on
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    features[0] = in[0];
    PolarPair<S>::at(in[1], in[2], in[3]).to_columns(features + 1);
  }
};
struct AlphaAndVectors {
  static constexpr auto kInputs = joined(Vectors::kInputs, std::array{kAlphaRow});
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    features[0] = in[6];
    PolarPair<S>::of(Vec3<S>(in[0], in[1], in[2]), Vec3<S>(in[3], in[4], in[5])).to_columns(features + 1);
  }
};
using AlphaForms = std::tuple<AlphaAndAngles, AlphaAndVectors>;
inline constexpr std::size_t kAlphaFeatures = 1 + kPolarColumns;

// The integral itself.
struct MicrofacetDiffuseRow {
  static constexpr std::string_view kName = "microfacet_diffuse";
  static constexpr std::string_view kText = "Lambertian microfacets with GGX normals, unshadowed: by quadrature";
  static constexpr const auto& kOutputs = kMicrofacetOutputs;
  static constexpr std::size_t kFeatures = kAlphaFeatures;
  using Forms = AlphaForms;
  template <Scalar S>
  static void evaluate(const S* features, S* out) {
    const auto value = microfacet_diffuse(features[0], PolarPair<S>::from_columns(features + 1));
    out[0] = value.f;
    out[1] = value.f_cos;
  }
};

// A table of it, with light and viewer on the same side of the normal whatever phi is.
struct MicrofacetDiffuseLut {
  static constexpr std::string_view kName = "microfacet_diffuse_lut";
  static constexpr std::string_view kText = "microfacet_diffuse from a table that holds phi at 0";
  static constexpr const auto& kOutputs = kMicrofacetOutputs;
  static constexpr std::size_t kFeatures = kAlphaFeatures;
  using Forms = AlphaForms;
  using Tables = MicrofacetDiffuseTable<1>;
  static const Tables& tables() {
    static const Tables kTables;
    return kTables;
  }
  template <Scalar S>
  static void evaluate(const Tables& tables, const S* features, S* out) {
    const auto value = tables.eval(features[0], PolarPair<S>::from_columns(features + 1));
    out[0] = value.f;
    out[1] = value.f_cos;
  }
};

// A table of it at three azimuths.
struct MicrofacetDiffuseAzimuthLut {
  static constexpr std::string_view kName = "microfacet_diffuse_azimuth_lut";
  static constexpr std::string_view kText = "microfacet_diffuse from a table at three azimuths, quadratic in cos(phi)";
  static constexpr const auto& kOutputs = kMicrofacetOutputs;
  static constexpr std::size_t kFeatures = kAlphaFeatures;
  using Forms = AlphaForms;
  using Tables = MicrofacetDiffuseTable<3>;
  static const Tables& tables() {
    static const Tables kTables;
    return kTables;
  }
  template <Scalar S>
  static void evaluate(const Tables& tables, const S* features, S* out) {
    const auto value = tables.eval(features[0], PolarPair<S>::from_columns(features + 1));
    out[0] = value.f;
    out[1] = value.f_cos;
  }
};

// The fit, also times the cosine.
struct MicrofacetDiffuseFitRow {
  using Model = MicrofacetDiffuseFit<double>;
  static constexpr std::string_view kName = Model::kName;
  static constexpr std::string_view kText = Model::kText;
  static constexpr std::array kOutputs{
      Output{.name = "f", .unit = "1/sr", .channels = 3, .text = "BRDF without the cosine, linear RGB"},
      Output{.name = "f_cos", .unit = "1/sr", .channels = 3, .text = "the same times cos_i, linear RGB"},
  };
  static constexpr std::size_t kOfPair = 3;  // what it reads of a pair of directions
  static constexpr std::size_t kFeatures = kOfPair + static_cast<std::size_t>(channel_count<Model>());

  template <class Directions>
  struct Lit {
    static constexpr auto kInputs = joined(Directions::kInputs, Model::kParameters);
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      using M = MicrofacetDiffuseFit<S>;
      const Geometry<S> g = Directions::template pair<S>(in);
      features[0] = M::lit_cosine(g);
      features[1] = M::side_of(g);
      features[2] = M::squares_of(g);
      for (std::size_t i = 0; i + kOfPair < kFeatures; ++i) features[kOfPair + i] = in[Directions::kInputs.size() + i];
    }
  };
  using Forms = std::tuple<Lit<Vectors>, Lit<HalfAngles>, Lit<PolarAngles>>;

  template <Scalar S>
  static void evaluate(const S* x, S* out) {
    const auto model = model_from_channels<MicrofacetDiffuseFit, S>(x + kOfPair);
    const Rgb<S> f = model.eval_at(x[0], x[1], x[2]), f_cos = model.eval_cos_at(x[0], x[1], x[2]);
    const S all[]{f.r, f.g, f.b, f_cos.r, f_cos.g, f_cos.b};
    for (std::size_t i = 0; i < 6; ++i) out[i] = all[i];
  }
};

using DiffuseEvaluators =
    std::tuple<MicrofacetDiffuseRow, MicrofacetDiffuseLut, MicrofacetDiffuseAzimuthLut, MicrofacetDiffuseFitRow>;

}  // namespace likeness::brdf
