#pragma once

#include "brdf/any_brdf.h"
#include "brdf/dual_normal.h"
#include "brdf/evaluator.h"
#include "brdf/normal_length.h"

// The surface models and their parts, as rows of `likeness eval`.
namespace likeness::brdf {

// ---- models that know f cos_i without a division return it beside f.

inline constexpr std::array kWithCosine{
    Output{.name = "f", .unit = "1/sr", .channels = 3, .text = "BRDF without the cosine, linear RGB"},
    Output{.name = "f_cos", .unit = "1/sr", .channels = 3, .text = "f cos_i, without a division by it"}};

template <Scalar S>
void store(const Rgb<S>& f, S* out) {
  out[0] = f.r;
  out[1] = f.g;
  out[2] = f.b;
}

template <template <class> class M>
struct SurfaceWithCosine : Surface<M> {
  static constexpr std::array kOutputs = kWithCosine;
  template <Scalar S>
  static void evaluate(const S* features, S* out) {
    const auto g = Geometry<S>::from_columns(features);
    const M<S> model = model_from_channels<M, S>(features + kGeometryColumns);
    store(model.eval(g), out);
    store(model.eval_cos(g), out + 3);
  }
};

// ---- models of a few cosines, which may be given themselves: independent numbers, whatever directions could have.

// clang-format off
inline constexpr Parameter kCosI{.name = "cos_i", .initial = 1, .range = {0, 1}, .typical = {0, 1}, .role = Role::kCoordinate,
                                 .text = "cosine between the normal and the light"};
inline constexpr Parameter kCosO{.name = "cos_o", .initial = 1, .range = {0, 1}, .typical = {0, 1}, .role = Role::kCoordinate,
                                 .text = "cosine between the normal and the viewer"};
inline constexpr Parameter kCosD{.name = "cos_d", .initial = 1, .range = {0, 1}, .typical = {0, 1}, .role = Role::kCoordinate,
                                 .text = "cosine between the light and the half vector"};
inline constexpr Parameter kCosVl{.name = "cos_vl", .initial = 1, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kCoordinate,
                                  .text = "cosine between the light and the viewer"};
// clang-format on

struct BurleyDiffuseRow : Surface<BurleyDiffuse> {
  struct Cosines {
    static constexpr auto kInputs = joined(std::array{kCosI, kCosO, kCosD}, BurleyDiffuse<double>::kParameters);
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      Geometry<S> g(Vec3<S>(S(0), S(0), S(1)), Vec3<S>(S(0), S(0), S(1)));
      g.cos_i = in[0];
      g.cos_o = in[1];
      g.cos_d = in[2];
      g.to_columns(features);
      for (std::size_t i = 0; i < 4; ++i) features[kGeometryColumns + i] = in[3 + i];
    }
  };
  using Forms = std::tuple<Lit<Vectors, BurleyDiffuse<double>>, Lit<HalfAngles, BurleyDiffuse<double>>,
                           Lit<PolarAngles, BurleyDiffuse<double>>, Cosines>;
};

// Features: cos_i (0 where either direction is at or below the horizon), proxima_turn, then the parameters.
struct ProximaRow {
  static constexpr std::string_view kName = Proxima<double>::kName;
  static constexpr std::string_view kText = Proxima<double>::kText;
  static constexpr std::array kOutputs = kWithCosine;
  static constexpr std::size_t kFeatures = 2 + static_cast<std::size_t>(channel_count<Proxima<double>>());

  template <class Directions>
  struct Lit {
    static constexpr auto kInputs = joined(Directions::kInputs, Proxima<double>::kParameters);
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const Geometry<S> g = Directions::template pair<S>(in);
      features[0] = pick(g.above, g.cos_i, S(0));
      features[1] = proxima_turn(g);
      for (std::size_t i = 0; i + 2 < kFeatures; ++i) features[2 + i] = in[Directions::kInputs.size() + i];
    }
  };
  struct Cosines {
    static constexpr auto kInputs = joined(std::array{kCosI, kCosVl}, Proxima<double>::kParameters);
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      features[0] = positive(in[0]);
      features[1] = proxima_turn(in[1], S(S(1) + in[1]));
      for (std::size_t i = 2; i < kFeatures; ++i) features[i] = in[i];
    }
  };
  using Forms = std::tuple<Lit<Vectors>, Lit<HalfAngles>, Lit<PolarAngles>, Cosines>;

  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const Proxima<S> model = model_from_channels<Proxima, S>(f + 2);
    store(model.eval_at(f[0], f[1]), out);
    store(model.eval_cos_at(f[0], f[1]), out + 3);
  }
};

// ---- Callisto about two normals.

struct DualNormal {
  static constexpr std::string_view kName = "dual_normal";
  static constexpr std::string_view kText = "Callisto with one normal for its diffuse and one for its specular";
  static constexpr std::array kOutputs{
      Output{.name = "f_cos", .unit = "1/sr", .channels = 3, .text = "each part times its own cosine, linear RGB"}};
  static constexpr std::size_t kFeatures =
      2 * kGeometryColumns + static_cast<std::size_t>(channel_count<Callisto<double>>());
  // clang-format off
  static constexpr std::array kNormals{
      Parameter{.name = "diffuse_normal_x", .initial = 0, .range = {-1, 1}, .typical = {-0.5, 0.5}, .role = Role::kDirection,
                .text = "unit normal of the diffuse in the surface's frame"},
      Parameter{.name = "diffuse_normal_y", .initial = 0, .range = {-1, 1}, .typical = {-0.5, 0.5}, .role = Role::kDirection, .text = "its y"},
      Parameter{.name = "diffuse_normal_z", .initial = 1, .range = {-1, 1}, .typical = {0.5, 1}, .role = Role::kDirection, .text = "its z"},
      Parameter{.name = "specular_normal_x", .initial = 0, .range = {-1, 1}, .typical = {-0.5, 0.5}, .role = Role::kDirection,
                .text = "unit normal of the specular lobes in the surface's frame"},
      Parameter{.name = "specular_normal_y", .initial = 0, .range = {-1, 1}, .typical = {-0.5, 0.5}, .role = Role::kDirection, .text = "its y"},
      Parameter{.name = "specular_normal_z", .initial = 1, .range = {-1, 1}, .typical = {0.5, 1}, .role = Role::kDirection, .text = "its z"},
  };
  // clang-format on
  struct Form {
    static constexpr auto kInputs = joined(joined(Vectors::kInputs, kNormals), Callisto<double>::kParameters);
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const Vec3<S> l(in[0], in[1], in[2]), v(in[3], in[4], in[5]);
      geometry_about(Vec3<S>(in[6], in[7], in[8]), l, v).to_columns(features);
      geometry_about(Vec3<S>(in[9], in[10], in[11]), l, v).to_columns(features + kGeometryColumns);
      for (std::size_t i = 2 * kGeometryColumns; i < kFeatures; ++i) features[i] = in[i + 12 - 2 * kGeometryColumns];
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const auto model = model_from_channels<Callisto, S>(f + 2 * kGeometryColumns);
    store(dual_normal(model, Geometry<S>::from_columns(f), Geometry<S>::from_columns(f + kGeometryColumns)), out);
  }
};

// ---- parts.

// The GGX distribution of normals alone.
struct GgxD {
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

struct NormalLength : Plain<NormalLength> {
  static constexpr std::string_view kName = "normal_length";
  static constexpr std::string_view kText = "length of the mean normal of GGX";
  // clang-format off
  static constexpr std::array kInputs{
      Parameter{.name = "alpha", .initial = 0.25, .range = {0, 1}, .typical = {1e-3, 1},
                .text = "slope roughness of GGX: the square of a roughness"},
  };
  static constexpr std::array kOutputs{Output{.name = "length", .text = "2/3 (alpha 1) to 1 (alpha 0)"}};
  // clang-format on
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = normal_length(f[0]);
  }
};

// Feature: 1 - length, which a float near 1 has lost.
struct RoughnessFromNormalLength {
  static constexpr std::string_view kName = "roughness_from_normal_length";
  static constexpr std::string_view kText = "roughness and alpha of the GGX whose mean normal has a length";
  static constexpr std::size_t kFeatures = 1;
  // clang-format off
  static constexpr std::array kOutputs{Output{.name = "roughness", .text = "square root of alpha"},
                                       Output{.name = "alpha", .text = "slope roughness of GGX"}};
  struct Form {
    static constexpr std::array kInputs{
        Parameter{.name = "length", .initial = 0.9, .range = {0, 1}, .typical = {2.0 / 3, 1},
                  .text = "of the mean normal; below 2/3 alpha is 1"},
    };
    // clang-format on
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      features[0] = S(1) - in[0];
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[1] = alpha_of_normal_deficit(f[0]);
    out[0] = safe_sqrt(out[1]);
  }
};

// The same without the iteration.
struct RoughnessNearNormalLength {
  static constexpr std::string_view kName = "roughness_near_normal_length";
  static constexpr std::string_view kText = "the same within 3.5 % of alpha, in one logarithm and one division";
  static constexpr std::size_t kFeatures = 1;
  static constexpr const auto& kOutputs = RoughnessFromNormalLength::kOutputs;
  using Forms = RoughnessFromNormalLength::Forms;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const S least = constant<S>(kTiny<S> * kTiny<S>), third = constant<S>(1.0 / 3);
    const S near = alpha2_near_normal_deficit(smaller(larger(f[0], least), third));
    out[1] = pick(greater(f[0], least), S(sqrt(near)), S(0));
    out[0] = safe_sqrt(out[1]);
  }
};

// With fewer steps of the iteration.
template <int kSteps>
struct RoughnessInSteps {
  static_assert(kSteps == 1 || kSteps == 2);
  static constexpr std::string_view kName =
      kSteps == 1 ? "roughness_from_normal_length_1" : "roughness_from_normal_length_2";
  static constexpr std::string_view kText =
      kSteps == 1 ? "the same by one step of Newton's method" : "the same by two steps of Newton's method";
  static constexpr std::size_t kFeatures = 1;
  static constexpr const auto& kOutputs = RoughnessFromNormalLength::kOutputs;
  using Forms = RoughnessFromNormalLength::Forms;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[1] = alpha_of_normal_deficit<kSteps>(f[0]);
    out[0] = safe_sqrt(out[1]);
  }
};

using SurfaceEvaluators =
    std::tuple<Surface<Lambert>, Surface<OrenNayar>, Surface<OrenNayar1994>, BurleyDiffuseRow, Surface<Disney2012>,
               Surface<Ggx>, GgxD, Surface<Callisto>, ProximaRow, SurfaceWithCosine<CallistoProxima>, DualNormal,
               NormalLength, RoughnessFromNormalLength, RoughnessInSteps<1>, RoughnessInSteps<2>,
               RoughnessNearNormalLength>;

}  // namespace likeness::brdf
