#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "brdf/lighting/spherical_gaussian.h"

// The lobes that all texels of an asset share, and the baked residual as their sum.
namespace likeness::brdf {

// e(v) = sum_k c_k G_k(v) [1/sr] towards a unit vector of the lobes' space, model space. One coefficient [1/sr] a lobe;
// the lobes' amplitudes multiply them and are 1 otherwise. 0 of no lobes. Every lobe counts and nothing is approximated:
// with as many lobes as lights this is the inverse of the bake.
template <Scalar S>
S residual(std::span<const WindowedGaussian<S>> lobes, std::span<const S> coefficients, const Vec3<S>& direction) {
  S sum(0.0);
  for (std::size_t k = 0; k < lobes.size(); ++k) sum = sum + coefficients[k] * lobes[k].eval(direction);
  return sum;
}

// Polynomials 1 + a_1 t + ... for exp(-t ln 100 / 4) on [0, 1], of which windowed_decay() takes the fourth power: minimax
// in the relative error, given that they are 1 at 0 (Remez, 40 digits). Highest power first, without the 1.
template <int kDegree>
inline constexpr std::array<double, kDegree> kDecay{};
template <>
inline constexpr std::array<double, 3> kDecay<3>{-0.14461000056703852, 0.60105281330468119, -1.1404324957200781};
template <>
inline constexpr std::array<double, 5> kDecay<5>{-0.0094743021940938257, 0.065560671759100227, -0.25049387998459594,
                                                 0.66185938877122746, -1.1512246708856823};
template <>
inline constexpr std::array<double, 7> kDecay<7>{-0.00029823027919589471, 0.0028845111942441444, -0.016567822602442226,
                                                 0.073069269762299646,    -0.25430064581895077,  0.66273304929363095,
                                                 -1.1512923663328962};

// WindowedGaussian by t = sharpness (1 - cos) / ln 100, without an exponential: (1 - t)^2 (1 + 2 t) p(t)^4, for
// exp(-t ln 100) W(1 - t). t in [0, 1]; it is 1 at t = 0 and 0 at t = 1.
// Error   relative to the value: 2.8e-3 of degree 3, 7.1e-6 of 5, 1.0e-8 of 7, and 2e-6 of float's own. Rounding a
//         coefficient to eight bits costs 4e-3.
template <int kDegree = 5, Scalar S>
S windowed_decay_within(const S& t) {
  S p = constant<S>(kDecay<kDegree>[0]);
  for (int i = 1; i < kDegree; ++i) p = multiply_add(p, t, constant<S>(kDecay<kDegree>[i]));
  p = multiply_add(p, t, S(1));
  const S left = S(1) - t, p2 = p * p;
  return left * left * multiply_add(S(2), t, S(1)) * (p2 * p2);
}
// The same for every t >= 0; 0 from 1 on.
template <int kDegree = 5, Scalar S>
S windowed_decay(const S& t) {
  return windowed_decay_within<kDegree>(smaller(t, S(1)));
}

// The lobes of an asset as the run time reads them: 32 bytes each. A byte names a lobe, and every byte may: lobes past
// those that were given have the scale 0 and add nothing, whatever a damaged file says.
struct RealisLobes {
  static constexpr std::size_t kMost = 256;

  struct alignas(32) Lobe {
    float x = 0, y = 0, z = 1;     // axis, unit, model space
    float reach = 0;               // sharpness / (2 ln 100): t = reach |axis - v|^2
    std::array<float, 3> scale{};  // multiplier / 127 of each channel: what a step of a coefficient's byte is [1/sr]
  };
  std::array<Lobe, kMost> lobes{};

  // `axis` unit; `sharpness` >= 0; `multiplier` [1/sr] of coefficient.h, of each channel or of all. Luminance is red.
  void place(std::size_t index, const Vec3<float>& axis, float sharpness, const Rgb<float>& multiplier) {
    const auto step = [](float of) { return static_cast<float>(of / 127.0); };
    lobes[index] = {axis.x,
                    axis.y,
                    axis.z,
                    static_cast<float>(sharpness / (2 * WindowedGaussian<double>::kEnd)),
                    {step(multiplier.r), step(multiplier.g), step(multiplier.b)}};
  }
  void place(std::size_t index, const Vec3<float>& axis, float sharpness, float multiplier) {
    place(index, axis, sharpness, Rgb<float>(multiplier));
  }

  // G of a lobe towards a unit vector in model space, [0, 1]. From the difference of the vectors, which keeps its digits
  // near the axis (versine_between).
  template <Scalar S>
  S eval(std::size_t index, const Vec3<S>& direction) const {
    const Lobe& lobe = lobes[index];
    const Vec3<S> d = Vec3<S>(constant<S>(lobe.x), constant<S>(lobe.y), constant<S>(lobe.z)) - direction;
    return windowed_decay(S(constant<S>(lobe.reach) * dot(d, d)));
  }
};

// scale G of every lobe towards one direction: what a step of a coefficient's byte adds [1/sr]. Of distant lights it is
// made once a light, and a texel then costs eight look-ups.
template <std::size_t kChannels = 1>
struct RealisTowards {
  std::array<std::array<float, RealisLobes::kMost>, kChannels> steps{};

  RealisTowards() = default;
  RealisTowards(const RealisLobes& lobes, const Vec3<float>& direction) {
    for (std::size_t k = 0; k < RealisLobes::kMost; ++k) {
      const auto& scale = lobes.lobes[k].scale;
      if (scale[0] == 0 && scale[1] == 0 && scale[2] == 0) continue;
      const float g = lobes.eval(k, direction);
      for (std::size_t c = 0; c < kChannels; ++c) steps[c][k] = scale[c] * g;
    }
  }
};

}  // namespace likeness::brdf
