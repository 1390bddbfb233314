#pragma once

#include "brdf/evaluator.h"
#include "brdf/hair/far.h"
#include "brdf/hair/fibre.h"

// What brdf/hair computes, as rows of `likeness eval`.
namespace likeness::brdf {

// clang-format off
inline constexpr Parameter kHairVariance{
    .name = "v", .initial = 0.1, .range = {1e-6, 100}, .typical = {1e-3, 1}, .unit = "rad^2", .logarithmic = true,
    .text = "longitudinal variance of the lobe"};
inline constexpr Parameter kHairWidth{
    .name = "s", .initial = 0.2, .range = {1e-3, 10}, .typical = {0.02, 0.6}, .unit = "rad", .logarithmic = true,
    .text = "width of the azimuthal logistic"};
inline constexpr Parameter kHairLobe{
    .name = "p", .initial = 0, .range = {0, 3}, .typical = {0, 2}, .role = Role::kCoordinate,
    .text = "lobe: 0 R, 1 TT, 2 TRT, 3 all longer paths"};
inline constexpr Parameter kHairAzimuth{
    .name = "phi", .initial = 0, .range = {-4 * kHalfPi, 4 * kHalfPi}, .typical = {-2 * kHalfPi, 2 * kHalfPi}, .unit = "rad",
    .role = Role::kAngle, .text = "azimuth about the fibre between the two directions; 0 is the same side"};
inline constexpr Parameter kHairOffset{
    .name = "h", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .unit = "radius", .role = Role::kCoordinate,
    .text = "offset of the ray from the axis of the fibre"};
inline constexpr Parameter kHairAbsorption{
    .name = "sigma_a", .initial = 0.2, .range = {0, 1e6}, .typical = {0, 3}, .unit = "1/radius", .role = Role::kShape,
    .text = "absorption inside the fibre, per radius"};
inline constexpr Parameter kHairEta{
    .name = "eta", .initial = 1.55, .range = {1, 3}, .typical = {1.3, 1.8}, .text = "refractive index of the fibre"};
inline constexpr Parameter kHairDifference{
    .name = "theta_d", .initial = 0, .range = {-kHalfPi, kHalfPi}, .typical = {-1.3, 1.3}, .unit = "rad",
    .role = Role::kAngle, .text = "inclination at which the light meets the fibre: half the difference of the two"};
// clang-format on
constexpr Parameter hair_inclination(std::string_view name, std::string_view text) {
  return {.name = name,
          .initial = 0,
          .range = {-kHalfPi, kHalfPi},
          .typical = {-1.4, 1.4},
          .unit = "rad",
          .role = Role::kAngle,
          .text = text};
}

struct HairMp {
  static constexpr std::string_view kName = "hair_mp";
  static constexpr std::string_view kText = "longitudinal scattering of a fibre, energy-conserving (d'Eon 2011)";
  static constexpr std::array kOutputs{
      Output{.name = "M", .text = "longitudinal term; its integral times cos(theta_i) is 1"}};
  static constexpr std::size_t kFeatures = 3;  // v, versine / v, cosines / v
  struct Form {
    static constexpr std::array kInputs{kHairVariance,
                                        hair_inclination("theta_i", "inclination of the light from the normal plane"),
                                        hair_inclination("theta_o", "inclination of the viewer from the normal plane")};
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
    // clang-format off
    static constexpr std::array kInputs{
        kHairLobe, kHairAzimuth, kHairWidth, kHairAbsorption, kHairEta, kHairDifference,
        Parameter{.name = "tolerance", .initial = 1e-9, .range = {1e-13, 1e-1}, .typical = {1e-9, 1e-3}, .role = Role::kCoordinate,
                  .logarithmic = true, .text = "relative error allowed to the quadrature"}};
    // clang-format on
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

// The whole fibre. Its features are those of HairTerms: what float directions would ruin is done before.
struct HairFibreRow {
  using Model = HairFibre<double>;
  static constexpr std::string_view kName = Model::kName;
  static constexpr std::string_view kText = Model::kText;
  static constexpr std::array kOutputs{
      Output{.name = "f", .unit = "1/sr", .channels = 3, .text = "scattering function without the cosine, linear RGB"},
      Output{.name = "f_cos", .unit = "1/sr", .channels = 3, .text = "with the cosine of theta_i, linear RGB"},
      Output{.name = "pdf", .unit = "1/sr", .text = "density with which sample() proposes the light"}};
  static constexpr std::size_t kFeatures = 21;

  template <Scalar S>
  static void store(const HairTerms<S>& t, S* out) {
    for (const S& x : t.v) *out++ = x;
    for (const S& x : t.versine) *out++ = x;
    for (const S& x : t.cosines) *out++ = x;
    for (const S& x : t.distance) *out++ = x;
    for (const S& x : {t.s, t.depth.r, t.depth.g, t.depth.b, t.reflected, t.transmitted, t.cos_i}) *out++ = x;
  }
  template <Scalar S>
  static HairTerms<S> terms(const S* f) {
    return {.v = {f[0], f[1], f[2]},
            .versine = {f[3], f[4], f[5], f[6]},
            .cosines = {f[7], f[8], f[9], f[10]},
            .distance = {f[11], f[12], f[13]},
            .s = f[14],
            .depth = {f[15], f[16], f[17]},
            .reflected = f[18],
            .transmitted = f[19],
            .cos_i = f[20]};
  }

  struct Angles {
    static constexpr auto kInputs =
        joined(std::array{hair_inclination("theta_i", "inclination of the light from the normal plane"),
                          hair_inclination("theta_o", "inclination of the viewer from the normal plane"), kHairAzimuth,
                          kHairOffset},
               Model::kParameters);
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const auto at = [](const S& theta) { return Inclination<S>{sin(theta), positive(S(cos(theta)))}; };
      const auto fibre = model_from_channels<HairFibre, S>(in + 4);
      store(fibre.view(at(in[1]), S(0), in[3]).terms(at(in[0]), in[2]), features);
    }
  };
  // Unit vectors in the frame of the fibre: x along it.
  struct Axes {
    static constexpr auto kInputs = joined(joined(Vectors::kInputs, std::array{kHairOffset}), Model::kParameters);
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const auto fibre = model_from_channels<HairFibre, S>(in + 7);
      store(fibre.view(Vec3<S>(in[3], in[4], in[5]), in[6]).terms(Vec3<S>(in[0], in[1], in[2])), features);
    }
  };
  using Forms = std::tuple<Angles, Axes>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const HairTerms<S> t = terms(f);
    const Rgb<S> f_cos = t.eval_cos();
    const S scale = S(1) / larger(t.cos_i, constant<S>(kTiny<S>));
    out[0] = f_cos.r * scale;
    out[1] = f_cos.g * scale;
    out[2] = f_cos.b * scale;
    out[3] = f_cos.r;
    out[4] = f_cos.g;
    out[5] = f_cos.b;
    out[6] = t.pdf();
  }
};

using HairEvaluators = std::tuple<HairMp, HairGauss, HairNear, HairFar, HairFibreRow>;

}  // namespace likeness::brdf
