#pragma once

#include "brdf/evaluator.h"
#include "brdf/hair/far_fibre.h"
#include "brdf/hair/kajiya_kay.h"

// Whole fibres as rows of `likeness eval`, and the inputs that rows about hair share.
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
inline constexpr Parameter kHairTolerance{
    .name = "tolerance", .initial = 1e-9, .range = {1e-13, 1e-1}, .typical = {1e-9, 1e-3}, .role = Role::kCoordinate,
    .logarithmic = true, .text = "relative error allowed to the quadrature"};
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
inline constexpr std::array kHairInclinations{
    hair_inclination("theta_i", "inclination of the light from the normal plane"),
    hair_inclination("theta_o", "inclination of the viewer from the normal plane")};

// theta as its sine and cosine; a cosine that rounding made negative at a pole is 0.
template <Scalar S>
Inclination<S> inclination_at(const S& theta) {
  return {S(sin(theta)), positive(S(cos(theta)))};
}
// Outputs f and f_cos.
template <Scalar T, Scalar S>
void write_scattering(const Rgb<T>& f_cos, const T& cos_i, S* out) {
  const T scale = T(1) / larger(cos_i, constant<T>(kHairLeastCosine));
  for (const T& x : {T(f_cos.r * scale), T(f_cos.g * scale), T(f_cos.b * scale), f_cos.r, f_cos.g, f_cos.b})
    *out++ = S(x);
}

// The whole fibre. Its features are those of HairTerms: what float directions would ruin is done before.
struct HairFibreRow {
  using Model = HairFibre<double>;
  static constexpr std::string_view kName = Model::kName;
  static constexpr std::string_view kText = Model::kText;
  static constexpr std::array kOutputs{
      Output{.name = "f", .unit = "1/sr", .channels = 3, .text = "scattering function without the cosine, linear RGB"},
      Output{.name = "f_cos", .unit = "1/sr", .channels = 3, .text = "with the cosine of theta_i, linear RGB"},
      Output{.name = "pdf", .unit = "1/sr", .text = "density with which sample() proposes the light"}};
  static constexpr std::size_t kFeatures = 28;

  template <Scalar S>
  static void store(const HairTerms<S>& t, S* out) {
    for (const S& x : t.v) *out++ = x;
    for (const S& x : t.versine) *out++ = x;
    for (const S& x : t.cosines) *out++ = x;
    for (const S& x : t.distance) *out++ = x;
    *out++ = t.s;
    for (const Rgb<S>& a : t.attenuations)
      for (const S& x : {a.r, a.g, a.b}) *out++ = x;
    *out++ = t.cos_i;
  }
  template <Scalar S>
  static HairTerms<S> terms(const S* f) {
    return {.v = {f[0], f[1], f[2]},
            .versine = {f[3], f[4], f[5], f[6]},
            .cosines = {f[7], f[8], f[9], f[10]},
            .distance = {f[11], f[12], f[13]},
            .s = f[14],
            .attenuations = {Rgb<S>{f[15], f[16], f[17]}, Rgb<S>{f[18], f[19], f[20]}, Rgb<S>{f[21], f[22], f[23]},
                             Rgb<S>{f[24], f[25], f[26]}},
            .cos_i = f[27]};
  }

  struct Angles {
    static constexpr auto kInputs =
        joined(std::array{kHairInclinations[0], kHairInclinations[1], kHairAzimuth, kHairOffset}, Model::kParameters);
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const auto fibre = model_from_channels<HairFibre, S>(in + 4);
      store(fibre.view(inclination_at(in[1]), S(0), in[3]).terms(inclination_at(in[0]), in[2]), features);
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
    const auto densities = t.densities();
    write_scattering(t.eval_cos(densities), t.cos_i, out);
    out[6] = t.pdf(densities);
  }
};

// The same from afar: averaged over the offset.
struct HairFibreFarRow {
  static constexpr std::string_view kName = "hair_fibre_far";
  static constexpr std::string_view kText = "a fibre of hair, far field: averaged over its width by quadrature";
  static constexpr std::array kOutputs{HairFibreRow::kOutputs[0], HairFibreRow::kOutputs[1]};
  static constexpr std::size_t kFeatures = HairFibreRow::kFeatures + 7;
  static constexpr bool kOneByOne = true;

  struct Angles {
    static constexpr auto kInputs = joined(
        joined(std::array{kHairInclinations[0], kHairInclinations[1], kHairAzimuth}, HairFibre<double>::kParameters),
        std::array{kHairTolerance});
    template <Scalar S>
    static void prepare(const S* in, S* f) {
      const auto fibre = model_from_channels<HairFibre, S>(in + 3);
      const auto t = hair_far_terms(fibre, inclination_at(in[0]), inclination_at(in[1]), in[2]);
      HairFibreRow::store(t.longitudinal, f);
      f += HairFibreRow::kFeatures;
      for (const S& x : {t.phi, t.eta, t.cos_o, t.sigma_a.r, t.sigma_a.g, t.sigma_a.b, in[10]}) *f++ = x;
    }
  };
  using Forms = std::tuple<Angles>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    using T = std::conditional_t<std::is_floating_point_v<S>, double, S>;  // floats by quadrature in double
    T wide[kFeatures];
    for (std::size_t i = 0; i < kFeatures; ++i) wide[i] = T(f[i]);
    const T* more = wide + HairFibreRow::kFeatures;
    const HairFarTerms<T> t{HairFibreRow::terms(wide), more[0], more[1], more[2], Rgb<T>{more[3], more[4], more[5]}};
    write_scattering(t.eval_cos(double(Arithmetic<T>::value(more[6]))), t.longitudinal.cos_i, out);
  }
};

struct KajiyaKayRow {
  using Model = KajiyaKay<double>;
  static constexpr std::string_view kName = Model::kName;
  static constexpr std::string_view kText = Model::kText;
  static constexpr std::array kOutputs{HairFibreRow::kOutputs[0], HairFibreRow::kOutputs[1]};
  static constexpr std::size_t kFeatures = 5 + 15;  // the angles, then the parameters but for the shifts
  struct Form {
    static constexpr auto kInputs =
        joined(std::array{kHairInclinations[0], kHairInclinations[1], kHairAzimuth}, Model::kParameters);
    template <Scalar S>
    static void prepare(const S* in, S* f) {
      const auto a = model_from_channels<KajiyaKay, S>(in + 3).angles(in[0], in[1], in[2]);
      for (const S& x : {a.cos_i, a.versine, a.primary, a.secondary, a.behind}) *f++ = x;
      for (int i = 0; i < 15; ++i) *f++ = in[3 + i];
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    S parameters[channel_count<Model>()];
    for (int i = 0; i < 15; ++i) parameters[i] = f[5 + i];
    parameters[15] = parameters[16] = S(0.0);
    const auto model = model_from_channels<KajiyaKay, S>(parameters);
    const typename KajiyaKay<S>::template Angles<S> a{f[0], f[1], f[2], f[3], f[4]};
    write_scattering(model.eval_cos(a), a.cos_i, out);
  }
};

}  // namespace likeness::brdf
