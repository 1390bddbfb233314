#pragma once

#include "brdf/evaluator.h"
#include "brdf/fresnel/conductor.h"
#include "brdf/fresnel/dielectric.h"
#include "brdf/fresnel/schlick.h"
#include "brdf/fresnel/thin_film_color.h"

// What brdf/fresnel computes, as rows of `likeness eval`.
namespace likeness::brdf {

// clang-format off
inline constexpr Parameter kCosine{
    .name = "cos_i", .initial = 1, .range = {0, 1}, .typical = {0, 1}, .role = Role::kCoordinate,
    .text = "cosine between the light and the normal of the surface or microfacet; clamped"};
inline constexpr Parameter kF0{
    .name = "f0", .initial = 0.04, .range = {0, 1}, .typical = {0.02, 0.9}, .role = Role::kScale, .channels = 3,
    .text = "reflectance at normal incidence, linear RGB"};
// clang-format on

// Features of the Schlick family: parameters, then 1 - cos.
template <class E>
struct FromVersine {
  static constexpr const auto& kInputs = E::kInputs;
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    constexpr std::size_t kLast = count_of(E::kInputs) - 1;
    for (std::size_t i = 0; i < kLast; ++i) features[i] = in[i];
    features[kLast] = S(1) - clamp01(in[kLast]);
  }
};

struct SchlickFresnel {
  static constexpr std::string_view kName = "schlick";
  static constexpr std::string_view kText = "Schlick's approximation of Fresnel reflectance";
  static constexpr std::array kInputs{kF0, kCosine};
  static constexpr std::array kOutputs{Output{.name = "F", .channels = 3, .text = "reflectance"}};
  static constexpr std::size_t kFeatures = 4;
  using Forms = std::tuple<FromVersine<SchlickFresnel>>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    for (int c = 0; c < 3; ++c) out[c] = schlick(f[c], f[3]);
  }
};

struct SchlickFalloff {
  static constexpr std::string_view kName = "schlick_falloff";
  static constexpr std::string_view kText = "Schlick's rise with Callisto's falloff";
  static constexpr std::array kInputs{kF0,
                                      Parameter{.name = "specular_fresnel_falloff",
                                                .initial = 0.5,
                                                .range = {0, 1},
                                                .typical = {0, 0.9},
                                                .text = "n_s: 0 no rise, 0.5 Schlick's, 1 white everywhere"},
                                      kCosine};
  static constexpr std::array kOutputs{Output{.name = "F", .channels = 3, .text = "reflectance"}};
  static constexpr std::size_t kFeatures = 5;
  using Forms = std::tuple<FromVersine<SchlickFalloff>>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const S weight = schlick_falloff_weight(f[3], f[4]);
    for (int c = 0; c < 3; ++c) out[c] = mix(f[c], S(1), weight);
  }
};

struct F82 {
  static constexpr std::string_view kName = "f82";
  static constexpr std::string_view kText = "Schlick's approximation with a tint at 82 degrees, for metals";
  static constexpr std::array kInputs{kF0,
                                      Parameter{.name = "tint",
                                                .initial = 1,
                                                .range = {0, 1},
                                                .typical = {0.5, 1},
                                                .role = Role::kTint,
                                                .channels = 3,
                                                .tints = "f0",
                                                .text = "reflectance at cos 1/7 over Schlick's there, linear RGB"},
                                      kCosine};
  static constexpr std::array kOutputs{Output{.name = "F", .channels = 3, .text = "reflectance"}};
  static constexpr std::size_t kFeatures = 9;  // f0, tint, F82Shape
  struct Form {
    static constexpr const auto& kInputs = F82::kInputs;
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const S cosine = clamp01(in[6]);
      const F82Shape<S> shape(cosine, S(S(1) - cosine));
      for (int i = 0; i < 6; ++i) features[i] = in[i];
      features[6] = shape.q;
      features[7] = shape.rest;
      features[8] = shape.rise;
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    F82Shape<S> shape;
    shape.q = f[6];
    shape.rest = f[7];
    shape.rise = f[8];
    for (int c = 0; c < 3; ++c) out[c] = f82(f[c], f[3 + c], shape);
  }
};

struct FresnelDielectric {
  static constexpr std::string_view kName = "fresnel_dielectric";
  static constexpr std::string_view kText = "Fresnel reflectance between transparent media, unpolarised";
  // clang-format off
  static constexpr std::array kInputs{
      Parameter{.name = "cos_i", .initial = 1, .range = {-1, 1}, .typical = {0, 1}, .role = Role::kCoordinate,
                .text = "cosine between the ray and the normal; below 0 it comes from behind, with 1 / eta"},
      Parameter{.name = "eta", .initial = 1.5, .range = {0.05, 20}, .typical = {0.5, 2.5},
                .text = "index behind the surface over that in front of it"},
  };
  // clang-format on
  static constexpr std::array kOutputs{Output{.name = "F", .text = "reflectance"}};
  static constexpr std::size_t kFeatures = 4;
  struct Form {
    static constexpr const auto& kInputs = FresnelDielectric::kInputs;
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const DielectricBoundary<S> b(in[0], in[1]);
      features[0] = b.cos_i;
      features[1] = b.index2;
      features[2] = b.contrast;
      features[3] = b.refracted_cos2;
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    DielectricBoundary<S> b;
    b.cos_i = f[0];
    b.index2 = f[1];
    b.contrast = f[2];
    b.refracted_cos2 = f[3];
    out[0] = fresnel_dielectric(b);
  }
};

struct FresnelConductor {
  static constexpr std::string_view kName = "fresnel_conductor";
  static constexpr std::string_view kText = "Fresnel reflectance of a metal, unpolarised";
  // clang-format off
  static constexpr std::array kInputs{
      kCosine,
      Parameter{.name = "eta", .initial = 0.2, .range = {0.05, 20}, .typical = {0.1, 3}, .channels = 3,
                .text = "real part of the index over that of the medium in front; one for each of RGB"},
      Parameter{.name = "k", .initial = 3.9, .range = {0, 20}, .typical = {1, 8}, .channels = 3,
                .text = "imaginary part, not negative"},
  };
  // clang-format on
  static constexpr std::array kOutputs{Output{.name = "F", .channels = 3, .text = "reflectance"}};
  static constexpr std::size_t kFeatures = 13;  // cos, then eta, k, |m^2 - 1|^2 and Re (m^2 - sin^2) of each channel
  struct Form {
    static constexpr const auto& kInputs = FresnelConductor::kInputs;
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      features[0] = clamp01(in[0]);
      for (int c = 0; c < 3; ++c) {
        const ConductorBoundary<S> b(in[0], in[1 + c], in[4 + c]);
        const S all[]{b.eta, b.k, b.contrast2, b.refracted_cos2};
        for (int i = 0; i < 4; ++i) features[1 + 4 * c + i] = all[i];
      }
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    for (int c = 0; c < 3; ++c) {
      const S* of = f + 1 + 4 * c;
      ConductorBoundary<S> b;
      b.cos_i = f[0];
      b.eta = of[0];
      b.k = of[1];
      b.contrast2 = of[2];
      b.refracted_cos2 = of[3];
      out[c] = fresnel_conductor(b);
    }
  }
};

// clang-format off
inline constexpr std::array kFilm{
    kCosine,
    Parameter{.name = "n0", .initial = 1, .range = {0.1, 10}, .typical = {1, 1.5}, .text = "index in front of the film"},
    Parameter{.name = "n1", .initial = 1.48, .range = {0.1, 10}, .typical = {1.2, 2.4}, .text = "index of the film"},
    Parameter{.name = "n2", .initial = 1.337, .range = {0.1, 10}, .typical = {1, 2.4}, .text = "index behind the film"},
    Parameter{.name = "thickness_nm", .initial = 60, .range = {0, 20000}, .typical = {0, 1500}, .unit = "nm",
              .text = "thickness of the film"},
};
// clang-format on

struct ThinFilmReflectance {
  static constexpr std::string_view kName = "thin_film";
  static constexpr std::string_view kText = "reflectance of one film on a substrate at one wavelength, unpolarised";
  static constexpr auto kInputs = joined(kFilm, std::array{Parameter{.name = "wavelength_nm",
                                                                     .initial = 550,
                                                                     .range = {100, 20000},
                                                                     .typical = {380, 780},
                                                                     .unit = "nm",
                                                                     .role = Role::kCoordinate,
                                                                     .text = "wavelength in vacuum"}});
  static constexpr std::array kOutputs{Output{.name = "R", .text = "reflectance"}};
  static constexpr std::size_t kFeatures = ThinFilm<double>::kColumns + 2;
  struct Form {
    static constexpr const auto& kInputs = ThinFilmReflectance::kInputs;
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const ThinFilm<S> film(in[0], in[1], in[2], in[3]);
      film.to_columns(features);
      const S k = constant<S>(2 * std::numbers::pi) * in[4] / in[5];
      features[ThinFilm<S>::kColumns] = k;
      features[ThinFilm<S>::kColumns + 1] = film_phase(k, film.g2);
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const auto film = ThinFilm<S>::from_columns(f);
    const S* wave = f + ThinFilm<S>::kColumns;
    out[0] = film.reflectance(film_wave(wave[0], film.g2, wave[1]));
  }
};

// The features of a film seen over the spectrum, before the inputs that follow it.
template <class E>
struct FromFilm {
  static constexpr const auto& kInputs = E::kInputs;
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    FilmSpectrum<S>(ThinFilm<S>(in[0], in[1], in[2], in[3]), in[4]).to_columns(features);
    constexpr std::size_t kRest = kInputs.size() - kFilm.size();
    for (std::size_t i = 0; i < kRest; ++i) features[FilmSpectrum<S>::kColumns + i] = in[kFilm.size() + i];
  }
};

struct ThinFilmRgb {
  static constexpr std::string_view kName = "thin_film_rgb";
  static constexpr std::string_view kText = "color of a film as the CIE 1931 observer sees it under D65";
  static constexpr const auto& kInputs = kFilm;
  static constexpr std::array kOutputs{
      Output{.name = "R",
             .channels = 3,
             .may_be_negative = true,
             .text = "reflectance in linear Rec. 709, white is (1, 1, 1), not clamped"}};
  static constexpr std::size_t kFeatures = FilmSpectrum<double>::kColumns;
  using Forms = std::tuple<FromFilm<ThinFilmRgb>>;
  using Tables = SpectralWeights;
  static const Tables& tables() {
    static const Tables kTables = rec709_under_d65();
    return kTables;
  }
  template <Scalar S>
  static void evaluate(const Tables& weights, const S* f, S* out) {
    const Rgb<S> color = FilmSpectrum<S>::from_columns(f).seen_with(weights);
    out[0] = color.r;
    out[1] = color.g;
    out[2] = color.b;
  }
};

struct ThinFilmCamera {
  static constexpr std::string_view kName = "thin_film_camera";
  static constexpr std::string_view kText = "color of a film as a camera of three Gaussian sensitivities sees it";
  // clang-format off
  static constexpr auto kInputs = joined(kFilm, std::array{
      Parameter{.name = "red_nm", .initial = 600, .range = {380, 740}, .typical = {580, 640}, .unit = "nm",
                .text = "wavelength at which the red channel peaks"},
      Parameter{.name = "green_nm", .initial = 540, .range = {380, 740}, .typical = {520, 560}, .unit = "nm",
                .text = "the green"},
      Parameter{.name = "blue_nm", .initial = 460, .range = {380, 740}, .typical = {440, 480}, .unit = "nm",
                .text = "the blue"},
      Parameter{.name = "width_nm", .initial = 35, .range = {5, 200}, .typical = {15, 50}, .unit = "nm",
                .text = "standard deviation of all three"},
  });
  // clang-format on
  static constexpr std::array kOutputs{
      Output{.name = "R", .channels = 3, .text = "reflectance in the camera's channels, white is (1, 1, 1)"}};
  static constexpr std::size_t kFeatures = FilmSpectrum<double>::kColumns + 4;
  using Forms = std::tuple<FromFilm<ThinFilmCamera>>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const S* camera = f + FilmSpectrum<S>::kColumns;
    const Rgb<S> color =
        FilmSpectrum<S>::from_columns(f).seen_with(GaussianCamera<S>{camera[0], camera[1], camera[2], camera[3]});
    out[0] = color.r;
    out[1] = color.g;
    out[2] = color.b;
  }
};

using FresnelEvaluators = std::tuple<SchlickFresnel, SchlickFalloff, F82, FresnelDielectric, FresnelConductor,
                                     ThinFilmReflectance, ThinFilmRgb, ThinFilmCamera>;

}  // namespace likeness::brdf
