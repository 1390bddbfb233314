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

// exp(-x) W(1 - x / ln 100), the windowed Gaussian by t = x / ln 100 >= 0, without an exponential: (1 - t)^2 (1 + 2 t)
// p(t)^4 with a polynomial p for exp(-t ln 100 / 4). t above 1 counts as 1; the value is then 0. 1 at t = 0.
// Error   3e-7 of the value in double, 7e-7 in float (minimax, p(0) = 1): a thousandth of what eight bits lose.
template <Scalar S>
S windowed_decay(const S& beyond) {
  const S t = smaller(beyond, S(1)), left = S(1) - t;
  S p = constant<S>(0.0018148429266209689);
  for (const double next : {-0.015057565004304902, 0.072011062713845834, -0.25392129718538077, 0.66266947480052779,
                            -1.1512887296934973, 1.0})
    p = p * t + constant<S>(next);
  const S p2 = p * p;
  return left * left * (S(1) + S(2) * t) * (p2 * p2);
}

// The lobes of an asset as the run time reads them: 32 bytes each. A byte names a lobe, and every byte may: lobes past
// those that were given have the scale 0 and add nothing, whatever a damaged file says.
struct RealisLobes {
  static constexpr std::size_t kMost = 256;

  struct alignas(32) Lobe {
    float x = 0, y = 0, z = 1;  // axis, unit, model space
    float reach = 0;            // sharpness / (2 ln 100): t = reach |axis - v|^2
    float scale = 0;            // multiplier / 127: what a step of a coefficient's byte is [1/sr]
  };
  std::array<Lobe, kMost> lobes{};

  // `axis` unit; `sharpness` >= 0; `multiplier` [1/sr] of coefficient.h.
  void place(std::size_t index, const Vec3<float>& axis, float sharpness, float multiplier) {
    lobes[index] = {axis.x, axis.y, axis.z, static_cast<float>(sharpness / (2 * WindowedGaussian<double>::kEnd)),
                    static_cast<float>(multiplier / 127.0)};
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
struct RealisTowards {
  std::array<float, RealisLobes::kMost> steps{};

  RealisTowards() = default;
  RealisTowards(const RealisLobes& lobes, const Vec3<float>& direction) {
    for (std::size_t k = 0; k < RealisLobes::kMost; ++k)
      if (lobes.lobes[k].scale != 0) steps[k] = lobes.lobes[k].scale * lobes.eval(k, direction);
  }
};

}  // namespace likeness::brdf
