#pragma once

#include "brdf/evaluator.h"
#include "brdf/lighting/compressed_harmonics.h"

// Spherical harmonics as rows of `likeness eval`.
namespace likeness::brdf {

// clang-format off
inline constexpr Parameter coefficient(std::string_view name, double initial, std::string_view text) {
  return {.name = name, .initial = initial, .range = {-1e6, 1e6}, .typical = {-1, 1}, .role = Role::kScale, .text = text};
}
inline constexpr std::array kCoefficients{
    coefficient("sh0", 1, "coefficient of band 0"),
    coefficient("sh1", 0, "of y"), coefficient("sh2", 0, "of z"), coefficient("sh3", 0, "of x"),
    coefficient("sh4", 0, "of xy"), coefficient("sh5", 0, "of yz"), coefficient("sh6", 0, "of 3z^2 - 1"),
    coefficient("sh7", 0, "of xz"), coefficient("sh8", 0, "of x^2 - y^2"),
};
inline constexpr std::array kDirection{
    Parameter{.name = "x", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "unit vector"},
    Parameter{.name = "y", .initial = 0, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its y"},
    Parameter{.name = "z", .initial = 1, .range = {-1, 1}, .typical = {-1, 1}, .role = Role::kDirection, .text = "its z"},
};
inline constexpr Output signed_output(std::string_view name, std::string_view text) {
  return {.name = name, .may_be_negative = true, .text = text};
}
// clang-format on

template <Scalar S>
Sh<S> sh_of(const S* in) {
  Sh<S> out;
  for (std::size_t i = 0; i < kShCount; ++i) out.c[i] = in[i];
  return out;
}

struct ShValue : Plain<ShValue> {
  static constexpr std::string_view kName = "sh";
  static constexpr std::string_view kText = "a function of nine spherical harmonics, and its irradiance";
  static constexpr auto kInputs = joined(kCoefficients, kDirection);
  static constexpr std::array kOutputs{signed_output("value", "at the direction"),
                                       signed_output("irradiance", "convolved with the clamped cosine about it")};
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const Sh<S> sh = sh_of(f);
    const Vec3<S> direction(f[9], f[10], f[11]);
    out[0] = sh.eval(direction);
    out[1] = sh.convolved_with_cosine().eval(direction);
  }
};

struct ShBasis : Plain<ShBasis> {
  static constexpr std::string_view kName = "sh_basis";
  static constexpr std::string_view kText = "the nine spherical harmonics of a direction: what a sample projects to";
  static constexpr const auto& kInputs = kDirection;
  static constexpr std::array kOutputs{
      signed_output("y0", "band 0"),      signed_output("y1", "of y"),  signed_output("y2", "of z"),
      signed_output("y3", "of x"),        signed_output("y4", "of xy"), signed_output("y5", "of yz"),
      signed_output("y6", "of 3z^2 - 1"), signed_output("y7", "of xz"), signed_output("y8", "of x^2 - y^2")};
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const auto y = Sh<S>::basis(Vec3<S>(f[0], f[1], f[2]));
    for (std::size_t i = 0; i < kShCount; ++i) out[i] = y[i];
  }
};

struct ShRotated {
  static constexpr std::string_view kName = "sh_rotated";
  static constexpr std::string_view kText = "spherical harmonics turned about an axis";
  // clang-format off
  static constexpr auto kInputs = joined(kCoefficients, std::array{
      Parameter{.name = "turn_x", .initial = 0, .range = {-10, 10}, .typical = {-3, 3}, .unit = "rad", .role = Role::kAngle,
                .text = "axis of the turn, as long as its angle"},
      Parameter{.name = "turn_y", .initial = 0, .range = {-10, 10}, .typical = {-3, 3}, .unit = "rad", .role = Role::kAngle, .text = "its y"},
      Parameter{.name = "turn_z", .initial = 0, .range = {-10, 10}, .typical = {-3, 3}, .unit = "rad", .role = Role::kAngle, .text = "its z"},
  });
  // clang-format on
  static constexpr std::array kOutputs{
      signed_output("r0", "band 0"),      signed_output("r1", "of y"),  signed_output("r2", "of z"),
      signed_output("r3", "of x"),        signed_output("r4", "of xy"), signed_output("r5", "of yz"),
      signed_output("r6", "of 3z^2 - 1"), signed_output("r7", "of xz"), signed_output("r8", "of x^2 - y^2")};
  static constexpr std::size_t kFeatures = 18;  // the coefficients and a matrix
  struct Form {
    static constexpr const auto& kInputs = ShRotated::kInputs;
    template <Scalar S>
    static void prepare(const S* in, S* features) {
      const auto r = Rotation<S>::about(Vec3<S>(in[9], in[10], in[11]));
      const S rows[]{r.x.x, r.x.y, r.x.z, r.y.x, r.y.y, r.y.z, r.z.x, r.z.y, r.z.z};
      for (std::size_t i = 0; i < 9; ++i) {
        features[i] = in[i];
        features[9 + i] = rows[i];
      }
    }
  };
  using Forms = std::tuple<Form>;
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    Rotation<S> r;
    r.x = {f[9], f[10], f[11]};
    r.y = {f[12], f[13], f[14]};
    r.z = {f[15], f[16], f[17]};
    const Sh<S> turned = sh_of(f).rotated(r);
    for (std::size_t i = 0; i < kShCount; ++i) out[i] = turned.c[i];
  }
};

struct ShCompressed : Plain<ShCompressed> {
  static constexpr std::string_view kName = "sh_compressed";
  static constexpr std::string_view kText = "bands 1 and 2 relative to band 0, in [0, 1], as they are stored";
  static constexpr const auto& kInputs = kCoefficients;
  static constexpr std::array kOutputs{Output{.name = "l0", .text = "band 0, not negative"},
                                       Output{.name = "e1", .text = "of y; 0.5 is 0"},
                                       Output{.name = "e2", .text = "of z"},
                                       Output{.name = "e3", .text = "of x"},
                                       Output{.name = "e4", .text = "of xy"},
                                       Output{.name = "e5", .text = "of yz"},
                                       Output{.name = "e6", .text = "of 3z^2 - 1"},
                                       Output{.name = "e7", .text = "of xz"},
                                       Output{.name = "e8", .text = "of x^2 - y^2"}};
  template <Scalar S>
  static void evaluate(const S* f, S* out) {
    const CompressedSh<S> compressed(sh_of(f));
    out[0] = compressed.l0;
    for (std::size_t i = 0; i < 8; ++i) out[i + 1] = compressed.e[i];
  }
};

}  // namespace likeness::brdf
