#pragma once

#include <utility>

#include "brdf/hair/dual_evaluators.h"
#include "brdf/hair/fibre_evaluators.h"
#include "brdf/hair/realtime_evaluators.h"

// What brdf/hair computes, as rows of `likeness eval`.
namespace likeness::brdf {

struct HairMp {
  static constexpr std::string_view kName = "hair_mp";
  static constexpr std::string_view kText = "longitudinal scattering of a fibre, energy-conserving (d'Eon 2011)";
  static constexpr std::array kOutputs{
      Output{.name = "M", .text = "longitudinal term; its integral times cos(theta_i) is 1"}};
  static constexpr std::size_t kFeatures = 3;  // v, versine / v, cosines / v
  struct Form {
    static constexpr std::array kInputs{kHairVariance, kHairInclinations[0], kHairInclinations[1]};
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const S sine = sin(S((in[1] + in[2]) * S(0.5)));
      features[0] = in[0];
      features[1] = S(2) * sine * sine / in[0];
      features[2] = positive(S(cos(in[1]))) * positive(S(cos(in[2]))) / in[0];
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = hair_mp(f[0], f[1], f[2]);
  }
};

struct HairGauss {
  static constexpr std::string_view kName = "hair_gauss";
  static constexpr std::string_view kText = "longitudinal scattering of a fibre as a Gaussian (Marschner 2003)";
  static constexpr std::array kOutputs{Output{.name = "M", .unit = "1/rad", .text = "g(beta, theta)"}};
  static constexpr std::size_t kFeatures = 2;
  struct Form {
    // clang-format off
    static constexpr std::array kInputs{
        Parameter{.name = "beta", .initial = 0.15, .range = {1e-3, 10}, .typical = {0.02, 0.5}, .unit = "rad",
                  .logarithmic = true, .text = "standard deviation"},
        Parameter{.name = "theta", .initial = 0, .range = {-2 * kHalfPi, 2 * kHalfPi}, .typical = {-0.5, 0.5}, .unit = "rad",
                  .role = Role::kAngle, .text = "theta_i + theta_o less the shift of the lobe"},
    };
    // clang-format on
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      features[0] = in[0];
      features[1] = in[1] / in[0];
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = hair_gauss(f[0], f[1]);
  }
};

struct HairNear {
  static constexpr std::string_view kName = "hair_near";
  static constexpr std::string_view kText = "azimuthal scattering of one lobe at one offset: A_p(h) D(phi - Phi(p, h))";
  static constexpr std::array kOutputs{Output{.name = "N", .unit = "1/rad", .text = "near field"}};
  static constexpr std::size_t kFeatures = 6;  // p, distance from the peak, s, optical depth, Fresnel both ways
  struct Form {
    static constexpr std::array kInputs{kHairLobe,       kHairAzimuth, kHairOffset,    kHairWidth,
                                        kHairAbsorption, kHairEta,     kHairDifference};
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const auto path = fibre_path(in[2], positive(S(cos(in[6]))), in[5]);
      features[0] = in[0];
      features[1] = azimuth_distance(in[0], in[1], path.gamma_i, path.gamma_t);
      features[2] = in[3];
      features[3] = S(2) * in[4] * path.chord;
      features[4] = path.reflected;
      features[5] = path.transmitted;
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = hair_near(f[0], f[1], f[2], f[3], f[4], f[5]);
  }
};

struct HairFar {
  static constexpr std::string_view kName = "hair_far";
  static constexpr std::string_view kText = "azimuthal scattering of one lobe over the width of a fibre, adaptive";
  static constexpr std::array kOutputs{Output{.name = "N", .unit = "1/rad", .text = "far field"}};
  static constexpr std::size_t kFeatures = 7;  // the inputs, theta_d by its cosine
  static constexpr bool kOneByOne = true;
  struct Form {
    static constexpr std::array kInputs{kHairLobe, kHairAzimuth,    kHairWidth,    kHairAbsorption,
                                        kHairEta,  kHairDifference, kHairTolerance};
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      for (std::size_t i = 0; i < kInputs.size(); ++i) features[i] = in[i];
      features[5] = positive(S(cos(in[5])));
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    if constexpr (std::is_floating_point_v<S>) {
      out[0] = S(hair_far<double>(int(f[0]), f[1], f[2], f[3], f[4], f[5], double(f[6])));
    } else {
      out[0] = hair_far<S>(int(Arithmetic<S>::value(f[0])), f[1], f[2], f[3], f[4], f[5],
                           double(Arithmetic<S>::value(f[6])));
    }
  }
};

using HairReferenceEvaluators =
    std::tuple<HairMp, HairGauss, HairNear, HairFar, HairFibreRow, HairFibreFarRow, KajiyaKayRow>;

// A tuple's elements after another's.
template <class... Tuples>
using Joined = decltype(std::tuple_cat(std::declval<Tuples>()...));

using HairEvaluators = Joined<HairReferenceEvaluators, HairRealtimeEvaluators, HairDualEvaluators>;

}  // namespace likeness::brdf
