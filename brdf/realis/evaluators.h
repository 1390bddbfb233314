#pragma once

#include "brdf/evaluator.h"
#include "brdf/realis.h"

// What brdf/realis computes, as rows of `likeness eval`.
namespace likeness::brdf {

// clang-format off
// A lobe's value is that of a stored coefficient. 1 - cos of the angle to its axis, then the rest.
inline constexpr std::array kRealisStored{
    Parameter{.name = "sharpness", .initial = 10, .range = {0, 1e6}, .typical = {0.5, 200}, .logarithmic = true,
              .text = "lambda; 0 is the same in all directions"},
    Parameter{.name = "byte", .initial = 255, .range = {0, 255}, .typical = {1, 255}, .role = Role::kScale,
              .text = "stored coefficient, a whole number; 128 is 0"},
    Parameter{.name = "multiplier", .initial = 1, .range = {0, 1e6}, .typical = {0, 0.5}, .unit = "1/sr", .role = Role::kScale,
              .text = "of the lobe: the coefficient of the byte 255"},
};
struct RealisByAxis {
  static constexpr auto kInputs = joined(std::array{
      Parameter{.name = "axis_x", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "unit vector of the lobe, model space"},
      Parameter{.name = "axis_y", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its y"},
      Parameter{.name = "axis_z", .initial = 1, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its z"},
      Parameter{.name = "x", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "unit vector to the light, model space"},
      Parameter{.name = "y", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its y"},
      Parameter{.name = "z", .initial = 1, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its z"},
  }, kRealisStored);
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    features[0] = versine_between(Vec3<S>(in[0], in[1], in[2]), Vec3<S>(in[3], in[4], in[5]));
    for (int i = 0; i < 3; ++i) features[1 + i] = in[6 + i];
  }
};
struct RealisByAngle {
  static constexpr auto kInputs = joined(std::array{
      Parameter{.name = "angle", .initial = 0, .range = {0, 2 * kHalfPi}, .typical = {0, kHalfPi}, .unit = "rad", .role = Role::kAngle,
                .text = "between the axis and the light"},
  }, kRealisStored);
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    features[0] = S(2) * squared(S(sin(S(S(0.5) * in[0]))));
    for (int i = 1; i < 4; ++i) features[i] = in[i];
  }
};
inline constexpr std::array kRealisLobeOutputs{
    Output{.name = "value", .unit = "1/sr", .may_be_negative = true, .text = "coefficient times lobe"}};
// clang-format on

struct RealisLobeExact {
  static constexpr std::string_view kName = "realis_lobe";
  static constexpr std::string_view kText = "one lobe of a baked residual, with its stored coefficient";
  static constexpr const auto& kOutputs = kRealisLobeOutputs;
  static constexpr std::size_t kFeatures = 4;
  using Forms = std::tuple<RealisByAxis, RealisByAngle>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    WindowedGaussian<S> lobe;
    lobe.plain.sharpness = f[1];
    out[0] = decoded(f[2], f[3]) * lobe.eval(f[0]);
  }
};

// The same with a polynomial in place of the exponential.
template <int kDegree>
struct RealisLobeDecay {
  static constexpr std::string_view kText = "realis_lobe without an exponential, by a polynomial of this degree";
  static constexpr const auto& kOutputs = kRealisLobeOutputs;
  static constexpr std::size_t kFeatures = 4;
  using Forms = std::tuple<RealisByAxis, RealisByAngle>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const S t = f[1] * f[0] * constant<S>(1 / WindowedGaussian<S>::kEnd);
    out[0] = decoded(f[2], f[3]) * windowed_decay<kDegree>(t);
  }
};
struct RealisLobe3 : RealisLobeDecay<3> {
  static constexpr std::string_view kName = "realis_lobe_3";
};
struct RealisLobe5 : RealisLobeDecay<5> {
  static constexpr std::string_view kName = "realis_lobe_5";
};
struct RealisLobe7 : RealisLobeDecay<7> {
  static constexpr std::string_view kName = "realis_lobe_7";
};

namespace realis_rows {
// clang-format off
constexpr Parameter axis(std::string_view name, double initial, std::string_view text) {
  return {.name = name, .initial = initial, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = text};
}
constexpr Parameter sharpness(std::string_view name) {
  return {.name = name, .initial = 10, .range = {0, 1e6}, .typical = {0.5, 200}, .logarithmic = true, .text = "its lambda"};
}
constexpr Parameter coefficient(std::string_view name, double initial) {
  return {.name = name, .initial = initial, .range = {-1e6, 1e6}, .typical = {-0.2, 0.2}, .unit = "1/sr", .role = Role::kScale,
          .text = "its coefficient"};
}
// clang-format on
}  // namespace realis_rows

// Three lobes stand for the eight of a texel: a row that a person can write.
struct RealisResidual {
  static constexpr std::string_view kName = "realis";
  static constexpr std::string_view kText = "a baked residual of three lobes, and what is seen of a surface with it";
  // clang-format off
  static constexpr std::array kInputs{
      Parameter{.name = "light_x", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "unit vector to the light, world"},
      Parameter{.name = "light_y", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its y"},
      Parameter{.name = "light_z", .initial = 1, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its z"},
      Parameter{.name = "turn_x", .initial = 0, .range = {-10, 10}, .typical = {-3, 3}, .unit = "rad", .role = Role::kAngle,
                .text = "rotation from the world to the model: its axis, as long as its angle"},
      Parameter{.name = "turn_y", .initial = 0, .range = {-10, 10}, .typical = {-3, 3}, .unit = "rad", .role = Role::kAngle, .text = "its y"},
      Parameter{.name = "turn_z", .initial = 0, .range = {-10, 10}, .typical = {-3, 3}, .unit = "rad", .role = Role::kAngle, .text = "its z"},
      Parameter{.name = "cos_i", .initial = 1, .range = {-1, 1}, .typical = {0, 1}, .role = Role::kCoordinate, .text = "cosine between the normal and the light"},
      Parameter{.name = "f_cos", .initial = 0.2, .range = {0, 1e6}, .typical = {0, 0.3}, .unit = "1/sr", .role = Role::kScale,
                .text = "BRDF times cosine of the plain model"},
      Parameter{.name = "floor", .initial = kRealisFloor, .range = {1e-3, 1}, .typical = {0.02, 0.3}, .role = Role::kShape,
                .text = "the least cosine that the bake divided by"},
      Parameter{.name = "weight", .initial = 1, .range = {0, 1}, .typical = {0, 1}, .role = Role::kMix, .text = "1, or less where the surface has changed (realis_fade)"},
      realis_rows::axis("a_x", 0, "unit vector of lobe a, model space"), realis_rows::axis("a_y", 0, "its y"), realis_rows::axis("a_z", 1, "its z"),
      realis_rows::sharpness("a_sharpness"), realis_rows::coefficient("a_coefficient", 0.1),
      realis_rows::axis("b_x", 0.6, "unit vector of lobe b"), realis_rows::axis("b_y", 0, "its y"), realis_rows::axis("b_z", 0.8, "its z"),
      realis_rows::sharpness("b_sharpness"), realis_rows::coefficient("b_coefficient", -0.05),
      realis_rows::axis("c_x", 0, "unit vector of lobe c"), realis_rows::axis("c_y", 0.6, "its y"), realis_rows::axis("c_z", 0.8, "its z"),
      realis_rows::sharpness("c_sharpness"), realis_rows::coefficient("c_coefficient", 0.02),
  };
  // clang-format on
  static constexpr std::array kOutputs{
      Output{.name = "e", .unit = "1/sr", .may_be_negative = true, .text = "the residual"},
      Output{
          .name = "seen", .unit = "1/sr", .text = "of unit light, cosine included, with the residual; not negative"}};
  static constexpr std::size_t kLobes = 3, kFirst = 10, kEach = 5;
  static constexpr std::size_t kFeatures = 4 + 3 * kLobes;
  struct Form {
    static constexpr const auto& kInputs = RealisResidual::kInputs;
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const Vec3<S> light = to_model(Rotation<S>::about(Vec3<S>(in[3], in[4], in[5])), Vec3<S>(S(1), S(1), S(1)),
                                     Vec3<S>(in[0], in[1], in[2]));
      for (std::size_t i = 0; i < 4; ++i) features[i] = in[6 + i];
      for (std::size_t k = 0; k < kLobes; ++k) {
        const S* lobe = in + kFirst + k * kEach;
        features[4 + 3 * k] = versine_between(Vec3<S>(lobe[0], lobe[1], lobe[2]), light);
        features[5 + 3 * k] = lobe[3];
        features[6 + 3 * k] = lobe[4];
      }
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    S e(0.0);
    for (std::size_t k = 0; k < kLobes; ++k) {
      WindowedGaussian<S> lobe;
      lobe.plain.sharpness = f[5 + 3 * k];
      e = e + f[6 + 3 * k] * lobe.eval(f[4 + 3 * k]);
    }
    out[0] = e;
    out[1] = with_residual(f[1], e, f[3], f[0], f[2]);
  }
};

struct RealisFaded {
  static constexpr std::string_view kName = "realis_fade";
  static constexpr std::string_view kText = "the weight of a residual on a surface that is no longer what was baked";
  // clang-format off
  static constexpr std::array kInputs{
      Parameter{.name = "baked_base_color", .initial = 0.5, .range = {0, 1}, .typical = {0, 1}, .role = Role::kScale, .channels = 3, .text = "at the bake, linear RGB"},
      Parameter{.name = "baked_roughness", .initial = 0.5, .range = {0, 1}, .typical = {0, 1}, .text = "at the bake"},
      Parameter{.name = "base_color", .initial = 0.5, .range = {0, 1}, .typical = {0, 1}, .role = Role::kScale, .channels = 3, .text = "now"},
      Parameter{.name = "roughness", .initial = 0.5, .range = {0, 1}, .typical = {0, 1}, .text = "now"},
      Parameter{.name = "tilt", .initial = 0, .range = {0, 2 * kHalfPi}, .typical = {0, 0.5}, .unit = "rad", .role = Role::kAngle,
                .text = "angle between the normal of the bake and that of now"},
  };
  // clang-format on
  static constexpr std::array kOutputs{Output{.name = "weight", .text = "of the residual, [0, 1]"}};
  static constexpr std::size_t kFeatures = 9;
  struct Form {
    static constexpr const auto& kInputs = RealisFaded::kInputs;
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      for (std::size_t i = 0; i < 8; ++i) features[i] = in[i];
      features[8] = S(2) * squared(S(sin(S(S(0.5) * in[8]))));
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = RealisFade{}.weight(Rgb<S>(f[0], f[1], f[2]), f[3], Rgb<S>(f[4], f[5], f[6]), f[7], f[8]);
  }
};

struct RealisDemodulated : Plain<RealisDemodulated> {
  static constexpr std::string_view kName = "realis_demodulated";
  static constexpr std::string_view kText = "the residual of an error of radiance, and the error of that residual";
  // clang-format off
  static constexpr std::array kInputs{
      Parameter{.name = "error", .initial = 0.1, .range = {-1e6, 1e6}, .typical = {-1, 1}, .unit = "W/(m2 sr)", .role = Role::kScale, .text = "photograph less render"},
      Parameter{.name = "light", .initial = 1, .range = {0, 1e6}, .typical = {0.1, 10}, .unit = "W/m2", .role = Role::kScale,
                .text = "irradiance of a surface that faces the light"},
      Parameter{.name = "cos_i", .initial = 1, .range = {-1, 1}, .typical = {0, 1}, .role = Role::kCoordinate, .text = "cosine between the normal and the light"},
      Parameter{.name = "floor", .initial = kRealisFloor, .range = {1e-3, 1}, .typical = {0.02, 0.3}, .text = "the least cosine to divide by"},
  };
  // clang-format on
  static constexpr std::array kOutputs{
      Output{.name = "e", .unit = "1/sr", .may_be_negative = true, .text = "the residual; 0 without light"},
      Output{
          .name = "again", .unit = "W/(m2 sr)", .may_be_negative = true, .text = "the error that the residual gives"}};
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = demodulated(f[0], f[1], f[2], f[3]);
    out[1] = modulated(out[0], f[1], f[2], f[3]);
  }
};

using RealisEvaluators =
    std::tuple<RealisResidual, RealisLobeExact, RealisLobe3, RealisLobe5, RealisLobe7, RealisFaded, RealisDemodulated>;

}  // namespace likeness::brdf
