#pragma once

#include "brdf/evaluator.h"
#include "brdf/subsurface/burley_profile.h"
#include "brdf/subsurface/gaussian_profile.h"

// Profiles over the distance, their CDF and its inverse, as rows of `likeness eval`.
namespace likeness::brdf {

// clang-format off
namespace diffusion_rows {
inline constexpr Parameter kRadius{.name = "r", .initial = 1, .range = {0, 1e9}, .typical = {0.01, 10}, .unit = "length",
                                   .role = Role::kCoordinate, .logarithmic = true, .text = "distance along the surface"};
inline constexpr Parameter kShape{.name = "s", .initial = 1, .range = {1e-6, 1e6}, .typical = {0.1, 10}, .unit = "1/length",
                                  .logarithmic = true, .text = "shape: 1 / s is the scattering distance"};
inline constexpr Parameter kAlbedo{.name = "A", .initial = 1, .range = {0, 1}, .typical = {0.1, 0.95}, .role = Role::kScale,
                                   .text = "surface albedo; 1 gives the normalised profile"};
inline constexpr Parameter kPart{.name = "u", .initial = 0.5, .range = {0, 1}, .typical = {0, 1}, .role = Role::kCoordinate,
                                 .text = "part of the light that leaves within r; 1 counts as 1 - 1e-30"};
inline constexpr Output kRadiusOut{.name = "r", .unit = "length", .text = "the distance within which the part u leaves"};
inline constexpr Output kReflectance{.name = "R", .unit = "1/length^2", .text = "radiant exitance at r, of 1 unit of flux that enters at a point"};
}  // namespace diffusion_rows

// x = s r and what multiplies a profile in x.
struct ProfileForm {
  static constexpr std::array kInputs{diffusion_rows::kRadius, diffusion_rows::kShape, diffusion_rows::kAlbedo};
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    features[0] = in[0] * in[1];
    features[1] = in[1];
    features[2] = in[2];
  }
};

struct BurleyProfile {
  static constexpr std::string_view kName = "burley_profile";
  static constexpr std::string_view kText = "Burley's normalised diffusion profile";
  static constexpr std::array kOutputs{
      diffusion_rows::kReflectance,
      Output{.name = "density_r", .unit = "1/length", .text = "density over the distance, 2 pi r R / A: integrates to 1"},
      Output{.name = "density_area", .unit = "1/length^2", .text = "density over the plane, R / A: integrates to 1"}};
  static constexpr std::size_t kFeatures = 3;
  using Forms = std::tuple<ProfileForm>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const S sum = burley_sum(f[0]), area = f[1] * f[1] * burley_density_over_area(f[0]);
    out[0] = f[2] * area;
    out[1] = f[1] * S(0.25) * sum;
    out[2] = area;
  }
};

struct BurleyCdf {
  static constexpr std::string_view kName = "burley_cdf";
  static constexpr std::string_view kText = "part of the light that leaves within a distance, of Burley's profile";
  static constexpr std::array kOutputs{Output{.name = "P", .text = "part that leaves within r"},
                                       Output{.name = "Q", .text = "the rest, 1 - P, with its digits far out"}};
  static constexpr std::size_t kFeatures = 1;
  struct Form {
    static constexpr std::array kInputs{diffusion_rows::kRadius, diffusion_rows::kShape};
    template <Scalar S>
    static void prepare(const S* in, S* features) { features[0] = in[0] * in[1]; }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = burley_cdf(f[0]);
    out[1] = burley_beyond(f[0]);
  }
};

// u, 1 - u and s.
struct PartForm {
  static constexpr std::array kInputs{diffusion_rows::kPart, diffusion_rows::kShape};
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    features[0] = in[0];
    features[1] = S(1) - in[0];
    features[2] = in[1];
  }
};

struct BurleyIcdf {
  static constexpr std::string_view kName = "burley_icdf";
  static constexpr std::string_view kText = "distance for a part of the light, of Burley's profile, in closed form";
  static constexpr std::array kOutputs{diffusion_rows::kRadiusOut};
  static constexpr std::size_t kFeatures = 3;
  using Forms = std::tuple<PartForm>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) { out[0] = burley_icdf(f[0], f[1]) / f[2]; }
};

struct BurleyIcdfHalley {
  static constexpr std::string_view kName = "burley_icdf_halley";
  static constexpr std::string_view kText = "the same by 1 to 4 steps of Halley's method, for comparison";
  static constexpr std::array kOutputs{diffusion_rows::kRadiusOut};
  static constexpr std::size_t kFeatures = 4;
  struct Form {
    static constexpr std::array kInputs{
        diffusion_rows::kPart, diffusion_rows::kShape,
        Parameter{.name = "steps", .initial = 2, .range = {1, 4}, .typical = {1, 4}, .text = "1, 2, 3 or 4; all four are computed"}};
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      PartForm::prepare(in, features);
      features[3] = in[2];
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    S x = burley_halley_start(f[0]), kept = x;
    for (int step = 1; step <= 4; ++step) {
      x = burley_halley_step(x, f[0], f[1]);
      kept = pick(greater(f[3], constant<S>(step - 0.5)), x, kept);
    }
    out[0] = kept / f[2];
  }
};

// The same with a number of steps that is known when compiling, which is what a step costs.
template <int kSteps>
struct BurleyIcdfHalleySteps {
  static constexpr std::array<char, 20> kLetters{'b', 'u', 'r', 'l', 'e', 'y', '_', 'i', 'c', 'd', 'f', '_', 'h', 'a', 'l', 'l', 'e', 'y', '_', '0' + kSteps};
  static constexpr std::string_view kName{kLetters.data(), kLetters.size()};
  static constexpr std::string_view kText = "burley_icdf_halley with a fixed number of steps";
  static constexpr std::array kOutputs{diffusion_rows::kRadiusOut};
  static constexpr std::size_t kFeatures = 3;
  using Forms = std::tuple<PartForm>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) { out[0] = burley_icdf_halley<kSteps>(f[0], f[1]) / f[2]; }
};

struct BurleyShape : Plain<BurleyShape> {
  static constexpr std::string_view kName = "burley_shape";
  static constexpr std::string_view kText = "the shape s of Burley's profile for a surface albedo";
  static constexpr std::array kInputs{diffusion_rows::kAlbedo};
  static constexpr std::array kOutputs{
      Output{.name = "searchlight", .unit = "1/mean free path", .text = "light enters along the normal"},
      Output{.name = "diffuse", .unit = "1/mean free path", .text = "light enters from all sides"},
      Output{.name = "dmfp", .unit = "1/diffuse mean free path", .text = "light enters along the normal, other length"}};
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    out[0] = burley_shape_searchlight(f[0]);
    out[1] = burley_shape_diffuse(f[0]);
    out[2] = burley_shape_dmfp(f[0]);
  }
};

// R and CDF of kCount Gaussians from (s r)^2, s and A.
template <int kCount, Scalar S>
std::array<S, 2> gaussian_row(const S* f) {
  return {S(f[2] * f[1] * f[1] * gaussian_density_over_area<kCount>(f[0])), gaussian_cdf<kCount>(f[0])};
}
inline constexpr std::array kGaussianProfileOutputs{
    Output{.name = "R", .unit = "1/length^2", .text = "as of burley_profile, without the delta at r = 0 of the single Gaussian"},
    Output{.name = "P", .text = "part of the light that leaves within r, the delta included"}};

struct GaussianForm {
  static constexpr const auto& kInputs = ProfileForm::kInputs;
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    ProfileForm::prepare(in, features);
    features[0] = features[0] * features[0];
  }
};

struct GaussianProfile {
  static constexpr std::string_view kName = "gaussian_profile";
  static constexpr std::string_view kText = "sum of 1 (with a delta), 2 or 4 Gaussians that stand for Burley's profile";
  static constexpr auto& kOutputs = kGaussianProfileOutputs;
  static constexpr std::size_t kFeatures = 4;
  struct Form {
    static constexpr std::array kInputs{
        Parameter{.name = "count", .initial = 4, .range = {1, 4}, .typical = {1, 4}, .text = "1, 2 or 4 Gaussians; all seven are computed"},
        diffusion_rows::kRadius, diffusion_rows::kShape, diffusion_rows::kAlbedo};
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      GaussianForm::prepare(in + 1, features);
      features[3] = in[0];
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const auto one = gaussian_row<1>(f), two = gaussian_row<2>(f), four = gaussian_row<4>(f);
    const auto more = greater(f[3], S(1.5)), most = greater(f[3], S(3));
    for (std::size_t i = 0; i < 2; ++i) out[i] = pick(most, four[i], pick(more, two[i], one[i]));
  }
};

// The same with a count that is known when compiling, which is what it costs.
template <int kCount>
struct GaussianProfileOf {
  static constexpr std::array<char, 18> kLetters{'g', 'a', 'u', 's', 's', 'i', 'a', 'n', '_', 'p', 'r', 'o', 'f', 'i', 'l', 'e', '_', '0' + kCount};
  static constexpr std::string_view kName{kLetters.data(), kLetters.size()};
  static constexpr std::string_view kText = "gaussian_profile with a fixed number of Gaussians";
  static constexpr auto& kOutputs = kGaussianProfileOutputs;
  static constexpr std::size_t kFeatures = 3;
  using Forms = std::tuple<GaussianForm>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const auto row = gaussian_row<kCount>(f);
    out[0] = row[0];
    out[1] = row[1];
  }
};
// clang-format on

}  // namespace likeness::brdf
