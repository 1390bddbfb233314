#pragma once

#include "brdf/evaluator.h"
#include "brdf/lighting/spherical_gaussian.h"

// Spherical Gaussians as rows of `likeness eval`.
namespace likeness::brdf {

// clang-format off
inline constexpr std::array kGaussian{
    Parameter{.name = "sharpness", .initial = 10, .range = {0, 1e6}, .typical = {0.5, 200}, .logarithmic = true,
              .text = "lambda; 0 is the same in all directions"},
    Parameter{.name = "amplitude", .initial = 1, .range = {0, 1e6}, .typical = {0, 10}, .role = Role::kScale, .text = "value on the axis"},
};

// By two unit vectors.
struct ByAxis {
  static constexpr auto kInputs = joined(std::array{
      Parameter{.name = "axis_x", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "unit vector of the lobe"},
      Parameter{.name = "axis_y", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its y"},
      Parameter{.name = "axis_z", .initial = 1, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its z"},
      Parameter{.name = "x", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "unit vector at which it is evaluated"},
      Parameter{.name = "y", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its y"},
      Parameter{.name = "z", .initial = 1, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its z"},
  }, kGaussian);
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    features[0] = versine_between(Vec3<S>(in[0], in[1], in[2]), Vec3<S>(in[3], in[4], in[5]));
    features[1] = in[6];
    features[2] = in[7];
  }
};
struct ByAngle {
  static constexpr auto kInputs = joined(std::array{
      Parameter{.name = "angle", .initial = 0, .range = {0, 2 * kHalfPi}, .typical = {0, kHalfPi}, .unit = "rad", .role = Role::kAngle,
                .text = "between the axis and the direction"},
  }, kGaussian);
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    features[0] = S(2) * squared(S(sin(S(S(0.5) * in[0]))));
    features[1] = in[1];
    features[2] = in[2];
  }
};
struct ByCosine {
  static constexpr auto kInputs = joined(std::array{
      Parameter{.name = "cos_angle", .initial = 1, .range = {-1, 1}, .typical = {0, 1}, .role = Role::kCoordinate,
                .text = "cosine between the axis and the direction"},
  }, kGaussian);
  template <Scalar S>
  static void prepare(const S* in, S* features) {
    features[0] = S(1) - in[0];
    features[1] = in[1];
    features[2] = in[2];
  }
};
// clang-format on

inline constexpr std::array kGaussianOutputs{Output{.name = "value", .text = "at the direction"},
                                             Output{.name = "integral", .text = "over the sphere"}};

struct PlainSphericalGaussian {
  static constexpr std::string_view kName = "spherical_gaussian";
  static constexpr std::string_view kText = "a Gaussian on the sphere, and its integral";
  static constexpr const auto& kOutputs = kGaussianOutputs;
  static constexpr std::size_t kFeatures = 3;
  using Forms = std::tuple<ByAxis, ByAngle, ByCosine>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    SphericalGaussian<S> lobe;
    lobe.sharpness = f[1];
    lobe.amplitude = f[2];
    out[0] = lobe.eval(f[0]);
    out[1] = lobe.integral();
  }
};

struct WindowedSphericalGaussian {
  static constexpr std::string_view kName = "spherical_gaussian_windowed";
  static constexpr std::string_view kText =
      "a Gaussian on the sphere that ends where it falls to 1 %, and its integral";
  static constexpr const auto& kOutputs = kGaussianOutputs;
  static constexpr std::size_t kFeatures = 3;
  using Forms = std::tuple<ByAxis, ByAngle, ByCosine>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    WindowedGaussian<S> lobe;
    lobe.plain.sharpness = f[1];
    lobe.plain.amplitude = f[2];
    out[0] = lobe.eval(f[0]);
    out[1] = lobe.integral();
  }
};

struct SphericalGaussianProduct {
  static constexpr std::string_view kName = "spherical_gaussian_product";
  static constexpr std::string_view kText = "the product of two spherical Gaussians, and its integral";
  // clang-format off
  static constexpr std::array kInputs{
      Parameter{.name = "angle", .initial = 0.5, .range = {0, 2 * kHalfPi}, .typical = {0, kHalfPi}, .unit = "rad", .role = Role::kAngle,
                .text = "between the axes"},
      Parameter{.name = "sharpness_a", .initial = 10, .range = {0, 1e6}, .typical = {0.5, 200}, .logarithmic = true, .text = "of the one"},
      Parameter{.name = "amplitude_a", .initial = 1, .range = {0, 1e6}, .typical = {0, 10}, .role = Role::kScale, .text = "its value on its axis"},
      Parameter{.name = "sharpness_b", .initial = 10, .range = {0, 1e6}, .typical = {0.5, 200}, .logarithmic = true, .text = "of the other"},
      Parameter{.name = "amplitude_b", .initial = 1, .range = {0, 1e6}, .typical = {0, 10}, .role = Role::kScale, .text = "its value on its axis"},
  };
  static constexpr std::array kOutputs{
      Output{.name = "axis_angle", .unit = "rad", .text = "from the axis of a, towards b's"},
      Output{.name = "sharpness", .text = "of the product"},
      Output{.name = "amplitude", .text = "of the product"},
      Output{.name = "inner_product", .text = "integral of the product over the sphere"},
  };
  // clang-format on
  static constexpr std::size_t kFeatures = 6;  // sine and cosine of the angle, then the rest
  struct Form {
    static constexpr const auto& kInputs = SphericalGaussianProduct::kInputs;
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      features[0] = sin(in[0]);
      features[1] = cos(in[0]);
      for (int i = 1; i < 5; ++i) features[i + 1] = in[i];
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    SphericalGaussian<S> a, b;
    a.sharpness = f[2];
    a.amplitude = f[3];
    b.axis = {f[0], S(0), f[1]};
    b.sharpness = f[4];
    b.amplitude = f[5];
    const SphericalGaussian<S> product = a * b;
    out[0] = atan2(product.axis.x, product.axis.z);
    out[1] = product.sharpness;
    out[2] = product.amplitude;
    out[3] = product.integral();
  }
};

}  // namespace likeness::brdf
