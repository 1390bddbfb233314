#pragma once

#include "brdf/lighting/spherical_gaussian.h"
#include "brdf/parameter.h"
#include "brdf/vector.h"

// Where a surface is no longer what was baked (dirt, blood, a decal, another material blended over it) the residual
// is not known, and fades out.
namespace likeness::brdf {

// What a bake was made with, or what the run time has now.
template <Scalar S>
struct RealisProperties {
  Rgb<S> base_color{S(0.5)};         // linear, [0, 1]
  S roughness = S(0.5);              // [0, 1]
  Vec3<S> normal{S(0), S(0), S(1)};  // unit, both in one space
};

// 1 up to `low`, 0 from `high` on, with slope 0 at both: 1 - smoothstep, written from where it ends, so that small
// weights keep their digits. low < high.
template <Scalar S>
S fading(const Interval& between, const S& x) {
  const S t = clamp01(S((constant<S>(between.high) - x) * constant<S>(1 / (between.high - between.low))));
  return t * t * (S(3) - S(2) * t);
}

// How far apart two base colors are, in [0, 1]: the largest difference of a channel, of the larger of both, or of 0.1
// where that is more, so that the last bits of dark colors do not count.
template <Scalar S>
S base_color_distance(const Rgb<S>& a, const Rgb<S>& b) {
  const auto channel = [](const S& x, const S& y) {
    return larger(S(x - y), S(y - x)) / larger(larger(x, y), constant<S>(0.1));
  };
  return larger(larger(channel(a.r, b.r), channel(a.g, b.g)), channel(a.b, b.b));
}

// How far the properties may differ before the residual fades, and where it is gone. The defaults leave it whole within
// what eight bits and a smaller texture lose.
struct RealisFade {
  Interval base_color{0.1, 0.5};  // of base_color_distance()
  Interval roughness{0.05, 0.3};  // of the difference
  Interval normal{0.004, 0.1};    // of 1 - cos of the angle between normals: 5 and 26 degrees

  // The residual's weight, in [0, 1]: 1 where all properties are those of the bake, 0 where one is not at all.
  template <Scalar S>
  S weight(const RealisProperties<S>& baked, const RealisProperties<S>& now) const {
    return weight(baked.base_color, baked.roughness, now.base_color, now.roughness,
                  versine_between(baked.normal, now.normal));
  }
  // The same with 1 - cos of the angle between the normals.
  template <Scalar S>
  S weight(const Rgb<S>& baked_color, const S& baked_roughness, const Rgb<S>& color_now, const S& roughness_now,
           const S& versine) const {
    const S difference = larger(S(baked_roughness - roughness_now), S(roughness_now - baked_roughness));
    return fading(base_color, base_color_distance(baked_color, color_now)) * fading(roughness, difference) *
           fading(normal, versine);
  }
};

}  // namespace likeness::brdf
