#pragma once

#include "brdf/lighting/spherical_harmonics.h"
#include "brdf/vector.h"

// The residual within shading: directions and cosines, and the way from radiance to residual and back.
namespace likeness::brdf {

// The cosine below which the bake divides no further, where a bake states none.
inline constexpr double kRealisFloor = 0.1;

// A direction in the space of the lobes. `model_from_world` turns it (rows: the model's axes in the world, unit and
// orthogonal, so no scale); `mirror` has -1 along the axes in which a part of the model that shares its texels with the
// other half is its mirror image, 1 elsewhere. Lobes are in model space: mirrored UVs alone change nothing.
template <Scalar S>
Vec3<S> to_model(const Rotation<S>& model_from_world, const Vec3<S>& mirror, const Vec3<S>& direction) {
  const Vec3<S> turned = model_from_world * direction;
  return {mirror.x * turned.x, mirror.y * turned.y, mirror.z * turned.z};
}

// What the residual is multiplied with in place of the cosine: max(cos_i, floor), in [floor, 1] with a floor in (0, 1],
// the bake's own. It never is 0, so that the bake is invertible also where the render's surface turns away from light.
template <Scalar S>
S floored_cosine(const S& cos_i, const S& floor) {
  return larger(cos_i, floor);
}

// e = E / (L max(cos_i, floor)) [1/sr] of the error E = photo - render [radiance] under a light that gives a surface which
// faces it the irradiance L. 0 where L is not above 0.
template <Scalar S>
S demodulated(const S& error, const S& light, const S& cos_i, const S& floor) {
  const auto lit = greater(light, constant<S>(kTiny<S>));
  return pick(lit, S(error / (pick(lit, light, S(1)) * floored_cosine(cos_i, floor))), S(0));
}

// E = e L max(cos_i, floor), the inverse of demodulated().
template <Scalar S>
S modulated(const S& residual, const S& light, const S& cos_i, const S& floor) {
  return residual * (light * floored_cosine(cos_i, floor));
}

// What is seen of a light of unit irradiance: f cos_i and the residual, never negative [1/sr]. `f_cos` is the plain
// model's value with its cosine, 0 below the horizon; `weight` in [0, 1] is that of fade.h.
template <Scalar S>
S with_residual(const S& f_cos, const S& residual, const S& weight, const S& cos_i, const S& floor) {
  return positive(S(f_cos + weight * residual * floored_cosine(cos_i, floor)));
}
template <Scalar S>
Rgb<S> with_residual(const Rgb<S>& f_cos, const Rgb<S>& residual, const S& weight, const S& cos_i, const S& floor) {
  return {with_residual(f_cos.r, residual.r, weight, cos_i, floor),
          with_residual(f_cos.g, residual.g, weight, cos_i, floor),
          with_residual(f_cos.b, residual.b, weight, cos_i, floor)};
}

}  // namespace likeness::brdf
